# Installs the tool with its manual pages and completion (component `tool`), the library, its public headers and a package that
# find_package(vdbsynth) finds (`dev`). The package's component `pipeline` adds the rooms that speak OpenVDB and finds it.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS vdb_synth RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT tool)
install(TARGETS vdbsynth EXPORT vdbsynthTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
install(TARGETS vdbsynth_pipeline EXPORT vdbsynthPipelineTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
install(EXPORT vdbsynthTargets NAMESPACE vdbsynth:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vdbsynth COMPONENT dev)
install(EXPORT vdbsynthPipelineTargets NAMESPACE vdbsynth:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vdbsynth COMPONENT dev)
include(libvdbsynth/public_headers.cmake)
foreach(header ${VDBSYNTH_PUBLIC_HEADERS})
  cmake_path(GET header PARENT_PATH room)
  install(FILES libvdbsynth/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/libvdbsynth/${room} COMPONENT dev)
endforeach()
configure_package_config_file(cmake/vdbsynthConfig.cmake.in ${PROJECT_BINARY_DIR}/vdbsynthConfig.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vdbsynth)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/vdbsynthConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/vdbsynthConfig.cmake ${PROJECT_BINARY_DIR}/vdbsynthConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vdbsynth COMPONENT dev)

# Where zsh looks depends on who installs.
set(zsh_functions ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  set(zsh_functions ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
endif()
install(DIRECTORY ${VDBSYNTH_MANUAL}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT tool)
install(FILES ${VDBSYNTH_MANUAL}/completion/vdb_synth DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT tool)
install(FILES ${VDBSYNTH_MANUAL}/completion/_vdb_synth DESTINATION ${zsh_functions} COMPONENT tool)
install(FILES ${VDBSYNTH_MANUAL}/completion/vdb_synth.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT tool)

# The Python module, a package of its own: `cmake --install --component python`. Debian's python3 looks there below /usr.
if(VDBSYNTH_PYTHON)
  set(VDBSYNTH_PYTHON_DESTINATION lib/python3/dist-packages CACHE STRING "Folder below the prefix that the Python module is installed into")
  install(TARGETS vdbsynth_python LIBRARY DESTINATION ${VDBSYNTH_PYTHON_DESTINATION}/vdbsynth COMPONENT python)
  install(FILES python/vdbsynth/__init__.py python/vdbsynth/__init__.pyi python/vdbsynth/py.typed
          DESTINATION ${VDBSYNTH_PYTHON_DESTINATION}/vdbsynth COMPONENT python)
endif()
if(PROJECT_IS_TOP_LEVEL)
  include(cmake/packages.cmake)
endif()
