# FindOpenVDB.cmake comes with Debian's package, outside the default module path, and switches
# BUILD_SHARED_LIBS on, which our own libraries answer by saying STATIC.
list(APPEND CMAKE_MODULE_PATH "/usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB")
# It also looks for Imath, whose Debian package names a Python library that it does not bring: pages of alarm about nothing.
set(CMAKE_MESSAGE_LOG_LEVEL NOTICE)
find_package(OpenVDB 10 REQUIRED COMPONENTS openvdb)
unset(CMAKE_MESSAGE_LOG_LEVEL)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(nanoflann REQUIRED)
find_package(PNG REQUIRED)
find_package(ZLIB REQUIRED)
find_package(tinyobjloader REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(Boost REQUIRED COMPONENTS program_options)
find_path(XXHASH_INCLUDE_DIR xxhash.h REQUIRED)
find_library(XXHASH_LIBRARY xxhash REQUIRED)
add_library(vdbsynth_xxhash INTERFACE)
target_include_directories(vdbsynth_xxhash SYSTEM INTERFACE ${XXHASH_INCLUDE_DIR})
target_link_libraries(vdbsynth_xxhash INTERFACE ${XXHASH_LIBRARY})
