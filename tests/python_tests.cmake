# What runs the program from Python, and the add-on for Blender. Each class is one ctest case.
set(PYTHON_ENVIRONMENT VDBSYNTH_PROGRAM=$<TARGET_FILE:vdb_synth> VDBSYNTH_SOURCE=${PROJECT_SOURCE_DIR} PYTHONDONTWRITEBYTECODE=1)
function(add_python_test file label)
  foreach(class ${ARGN})
    add_test(NAME "${label}: ${file} ${class}" COMMAND /usr/bin/python3 ${PROJECT_SOURCE_DIR}/tests/${label}/${file}.py ${class})
    set_tests_properties("${label}: ${file} ${class}" PROPERTIES ENVIRONMENT "${PYTHON_ENVIRONMENT}" LABELS ${label} TIMEOUT 900)
  endforeach()
endfunction()

add_python_test(tool_test python Tool)
add_python_test(parts_test blender Methods Ply)
add_python_test(headless_test blender Headless)
