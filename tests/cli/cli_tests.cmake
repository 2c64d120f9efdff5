# Each class of the Python tests is one ctest case.
set(CLI_ENVIRONMENT VDBSYNTH_PROGRAM=$<TARGET_FILE:vdb_synth> VDBSYNTH_SAMPLES=${VDBSYNTH_SAMPLES} VDBSYNTH_SOURCE=${PROJECT_SOURCE_DIR}
    PYTHONDONTWRITEBYTECODE=1)
function(add_cli_test file)
  foreach(class ${ARGN})
    add_test(NAME "cli: ${file} ${class}" COMMAND /usr/bin/python3 ${PROJECT_SOURCE_DIR}/tests/cli/${file}.py ${class})
    set_tests_properties("cli: ${file} ${class}" PROPERTIES ENVIRONMENT "${CLI_ENVIRONMENT}" LABELS cli TIMEOUT 600)
  endforeach()
endfunction()

add_cli_test(analogy_test Analogy)
add_cli_test(compare_test Compare Libraries Page)
add_cli_test(options_test Answers Overwriting Help Moved)
add_cli_test(path_test Attributes Doors StandardStreams MainPath Determinism Words)
add_cli_test(error_test BadOptions BadFiles Disk Signals)
add_cli_test(readme_test Readme)
add_cli_test(repeat_test Repeat)
add_cli_test(reported_gltf_test Gltf)
add_cli_test(reported_images_test Images)
add_cli_test(reported_obj_test Polygons Dialects)
add_cli_test(reported_points_test Rows Columns Files Outliers Pcd Arrays)
add_cli_test(reported_stl_test Files Kinds)
add_cli_test(reported_volumes_test VtiFiles NiftiFiles ArrayFiles TextVolumes TurnedVolumes)
add_cli_test(rival_test Rival)
add_cli_test(synth_test Synth)
add_cli_test(programs_test Programs)

# A short run of every fuzz target; tools/dev/fuzz.sh runs them for longer.
add_test(NAME "fuzz: readers" COMMAND ${PROJECT_SOURCE_DIR}/tools/dev/fuzz.sh 3)
set_tests_properties("fuzz: readers" PROPERTIES LABELS "fuzz;slow" TIMEOUT 1200 SKIP_RETURN_CODE 77)

add_test(NAME "lint: stairs" COMMAND /usr/bin/python3 ${PROJECT_SOURCE_DIR}/tools/dev/check_stairs.py ${PROJECT_SOURCE_DIR})
add_test(NAME "lint: format" COMMAND ${PROJECT_SOURCE_DIR}/tools/dev/check_format.sh)
add_test(NAME "lint: headers" COMMAND ${PROJECT_SOURCE_DIR}/tools/dev/check_headers.sh ${CMAKE_CXX_COMPILER})
add_test(NAME "lint: performance page" COMMAND /usr/bin/python3 ${PROJECT_SOURCE_DIR}/tools/dev/check_performance.py)
set_tests_properties("lint: stairs" "lint: format" "lint: headers" "lint: performance page" PROPERTIES LABELS lint SKIP_RETURN_CODE 77)

add_test(NAME "consumer: find_package" COMMAND ${PROJECT_SOURCE_DIR}/tests/consumer/run.sh ${CMAKE_COMMAND} ${PROJECT_BINARY_DIR})
set_tests_properties("consumer: find_package" PROPERTIES LABELS consumer TIMEOUT 300)
