# Each class of the Python tests is one ctest case.
set(CLI_ENVIRONMENT VDBSYNTH_PROGRAM=$<TARGET_FILE:vdb_synth> VDBSYNTH_SAMPLES=${VDBSYNTH_SAMPLES} VDBSYNTH_SOURCE=${PROJECT_SOURCE_DIR}
    PYTHONDONTWRITEBYTECODE=1)
function(add_cli_test file)
  foreach(class ${ARGN})
    add_test(NAME "cli: ${file} ${class}" COMMAND /usr/bin/python3 ${PROJECT_SOURCE_DIR}/tests/cli/${file}.py ${class})
    set_tests_properties("cli: ${file} ${class}" PROPERTIES ENVIRONMENT "${CLI_ENVIRONMENT}" LABELS cli TIMEOUT 600)
  endforeach()
endfunction()

add_cli_test(about_test Versions Doctor Manual Completion)
add_cli_test(analogy_test Analogy)
add_cli_test(batch_test Plans Refusals Runs Kills)
add_cli_test(slurm_test Refusals Runs Kills)
# These start munged, slurmctld and two slurmd, and skip where they are not installed (packages.sh all) or not run by root.
# Minutes of stopping and starting: tools/run_tests.sh --all.
set_tests_properties("cli: slurm_test Runs" "cli: slurm_test Kills" "cli: batch_test Kills" PROPERTIES LABELS "cli;all;slow")
add_cli_test(compare_test Compare Libraries Page)
add_cli_test(options_test Answers Overwriting Help Moved)
add_cli_test(patch_test Sheets Refused)
add_cli_test(patch_onto_test Over)
add_cli_test(patches_test PatchMeasures)
add_cli_test(formats_test Formats)
add_cli_test(frames_test Frames Poses TwistedBunny)
add_cli_test(path_test Attributes Doors StandardStreams MainPath Determinism Words)
add_cli_test(error_test BadOptions BadFiles Disk Signals)
set_tests_properties("cli: error_test Signals" PROPERTIES LABELS "cli;all;slow")
add_cli_test(readme_test Readme)
add_cli_test(relief_extract_test ReliefExtract)
add_cli_test(relief_test Relief Masks Hostile)
add_cli_test(render_test Pictures Fog Pages)
add_cli_test(repeat_test Repeat)
add_cli_test(reported_gltf_test Gltf)
add_cli_test(reported_images_test Images)
add_cli_test(reported_obj_test Polygons Dialects)
add_cli_test(reported_points_test Rows Columns Files Outliers Pcd Arrays)
add_cli_test(reported_solids_test Solids Places Unused)
add_cli_test(reported_stl_test Files Kinds)
add_cli_test(reported_vdb_test Files Dialects Damage)
add_cli_test(reported_volumes_test VtiFiles NiftiFiles ArrayFiles TextVolumes TurnedVolumes)
add_cli_test(rings_test BrokenRings RingNumbers Rings)
add_cli_test(rival_test Rival)
add_cli_test(synth_test Synth)
add_cli_test(texture_test Texture Pictures Hostile)
add_cli_test(threemf_test ThreeMf)
add_cli_test(volumes_test Outputs Readers Scans)
add_cli_test(programs_test Programs)
add_cli_test(troubleshooting_test Words Provoked)
add_cli_test(docs_test Links Options Commands)

# Links the objects of this build into programs of few commands.
add_cli_test(demo_build_test Demo Each)
set_tests_properties("cli: demo_build_test Demo" "cli: demo_build_test Each" PROPERTIES ENVIRONMENT "${CLI_ENVIRONMENT};VDBSYNTH_BUILD=${PROJECT_BINARY_DIR}")
set_tests_properties("cli: demo_build_test Each" PROPERTIES LABELS "all;slow")

# Packs the build folder, makes a bare Debian and builds the container: tools/run_tests.sh --all.
add_cli_test(packages_test Packages Container)
set_tests_properties("cli: packages_test Packages" "cli: packages_test Container" PROPERTIES ENVIRONMENT
                     "${CLI_ENVIRONMENT};VDBSYNTH_BUILD=${PROJECT_BINARY_DIR}" LABELS all)
set_tests_properties("cli: packages_test Container" PROPERTIES TIMEOUT 1800)

# Full disks, little memory, signals, many jobs: tools/run_tests.sh --all. VDBSYNTH_SIGNALS and VDBSYNTH_SOAK make it long.
add_cli_test(night_disk_test FullDisk FullDiskOfBatch Folders Memory)
add_cli_test(night_shift_test Signals TwoBatches Soak Threads JobFiles)
foreach(class "night_disk_test FullDisk" "night_disk_test FullDiskOfBatch" "night_disk_test Folders" "night_disk_test Memory"
        "night_shift_test Signals" "night_shift_test TwoBatches" "night_shift_test Soak" "night_shift_test Threads" "night_shift_test JobFiles")
  set_tests_properties("cli: ${class}" PROPERTIES LABELS "all;slow" TIMEOUT 7200)
endforeach()

# A short run of every fuzz target; tools/dev/fuzz.sh runs them for longer.
add_test(NAME "fuzz: readers" COMMAND ${PROJECT_SOURCE_DIR}/tools/dev/fuzz.sh 3)
set_tests_properties("fuzz: readers" PROPERTIES LABELS "fuzz;all;slow" TIMEOUT 1200 SKIP_RETURN_CODE 77)

add_test(NAME "lint: stairs" COMMAND /usr/bin/python3 ${PROJECT_SOURCE_DIR}/tools/dev/check_stairs.py ${PROJECT_SOURCE_DIR})
add_test(NAME "lint: format" COMMAND ${PROJECT_SOURCE_DIR}/tools/dev/check_format.sh)
add_test(NAME "lint: headers" COMMAND ${PROJECT_SOURCE_DIR}/tools/dev/check_headers.sh ${CMAKE_CXX_COMPILER})
add_test(NAME "lint: performance page" COMMAND /usr/bin/python3 ${PROJECT_SOURCE_DIR}/tools/dev/check_performance.py)
set_tests_properties("lint: stairs" "lint: format" "lint: headers" "lint: performance page" PROPERTIES LABELS lint SKIP_RETURN_CODE 77)

add_test(NAME "consumer: find_package" COMMAND ${PROJECT_SOURCE_DIR}/tests/consumer/run.sh ${CMAKE_COMMAND} ${PROJECT_BINARY_DIR})
set_tests_properties("consumer: find_package" PROPERTIES LABELS consumer TIMEOUT 300)
