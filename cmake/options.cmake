# What every target of ours is compiled with.
add_library(vdbsynth_options INTERFACE)
target_compile_features(vdbsynth_options INTERFACE cxx_std_17)
# No contraction: a fused multiply-add has another last bit, and results must be the same everywhere.
target_compile_options(vdbsynth_options INTERFACE -Wall -Wextra -Wshadow -Wconversion -ffp-contract=off)
if(VDBSYNTH_WERROR)
  target_compile_options(vdbsynth_options INTERFACE -Werror)
endif()
if(VDBSYNTH_SANITIZE)
  target_compile_options(vdbsynth_options INTERFACE -fsanitize=${VDBSYNTH_SANITIZE} -fno-omit-frame-pointer)
  target_link_options(vdbsynth_options INTERFACE -fsanitize=${VDBSYNTH_SANITIZE})
endif()
