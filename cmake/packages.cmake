# Debian packages by `cpack`: the tool, the library for programs, and the Python module where it is built.
# tools/dev/make_packages.sh builds them.
set(VDBSYNTH_MAINTAINER "vdb_synth authors <maintainers@vdb-synth.invalid>" CACHE STRING "Maintainer of Debian packages")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME vdb-synth)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL tool dev)
if(VDBSYNTH_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER ${VDBSYNTH_MAINTAINER})

set(CPACK_DEBIAN_TOOL_PACKAGE_NAME vdb-synth)
set(CPACK_DEBIAN_TOOL_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_TOOL_PACKAGE_SHLIBDEPS ON)
set(CPACK_COMPONENT_TOOL_DESCRIPTION
    "make new geometry from examples\nSynthesizes level sets, meshes, points and textures like an exemplar.\nThis package holds the program vdb_synth, its manual pages and\ncompletion for shells.")

# Archives to link with: what they need is not in them, so the names are written here. cmake/vdbsynthConfig.cmake.in finds
# the same.
set(CPACK_DEBIAN_DEV_PACKAGE_NAME libvdbsynth-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(dev_needs libopenvdb-dev libboost-iostreams-dev libtbb-dev libjpeg62-turbo-dev libpng-dev libtinygltf-dev libpugixml-dev
    libopenexr-dev libxxhash-dev liblz4-dev zlib1g-dev)
if(VDBSYNTH_TIFF)
  list(APPEND dev_needs libtiff-dev)
endif()
list(JOIN dev_needs ", " CPACK_DEBIAN_DEV_PACKAGE_DEPENDS)
set(CPACK_DEBIAN_DEV_PACKAGE_RECOMMENDS cmake)
set(CPACK_COMPONENT_DEV_DESCRIPTION
    "make new geometry from examples (library)\nThe libraries, headers and CMake package of vdb_synth:\nfind_package(vdbsynth), with the component pipeline for programs\nthat use OpenVDB.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-vdbsynth)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
# A module is of one minor version of Python, that of the interpreter it was built for.
if(VDBSYNTH_PYTHON)
  execute_process(COMMAND ${Python3_EXECUTABLE} -c "import sys; a, b = sys.version_info[:2]; print(f'python3 (>= {a}.{b}), python3 (<< {a}.{b + 1})')"
                  OUTPUT_VARIABLE interpreter OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "${interpreter}, python3-numpy")
endif()
set(CPACK_COMPONENT_PYTHON_DESCRIPTION
    "make new geometry from examples (Python module)\nThe functions of vdb_synth for Python: import vdbsynth.")

# What Debian's policy asks of every package.
execute_process(COMMAND date -u -R -d ${VDBSYNTH_DATE} OUTPUT_VARIABLE written OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
set(copyright "vdb_synth\n\nCopyright (C) 2026 vdb_synth authors\nLicense: Apache-2.0\n\nThe text of the license is in /usr/share/common-licenses/Apache-2.0.\n")
foreach(component ${CPACK_COMPONENTS_ALL})
  string(TOUPPER ${component} upper)
  set(package ${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  set(folder ${PROJECT_BINARY_DIR}/debian/${package})
  file(WRITE ${folder}/copyright "${copyright}")
  file(WRITE ${folder}/changelog "vdb-synth (${PROJECT_VERSION}) unstable; urgency=medium\n\n  * CHANGELOG.md in this folder lists the changes.\n\n -- ${VDBSYNTH_MAINTAINER}  ${written}\n")
  execute_process(COMMAND gzip -9nf changelog WORKING_DIRECTORY ${folder} ERROR_QUIET)
  install(FILES ${folder}/copyright ${folder}/changelog.gz CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package}
          COMPONENT ${component} OPTIONAL)
endforeach()

include(CPack)
