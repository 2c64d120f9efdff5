# Installs the tool, the library, its public headers and a package that find_package(vdbsynth) finds. The component
# `pipeline` adds the rooms that speak OpenVDB and finds it.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS vdb_synth RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS vdbsynth EXPORT vdbsynthTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS vdbsynth_pipeline EXPORT vdbsynthPipelineTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT vdbsynthTargets NAMESPACE vdbsynth:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vdbsynth)
install(EXPORT vdbsynthPipelineTargets NAMESPACE vdbsynth:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vdbsynth)
include(libvdbsynth/public_headers.cmake)
foreach(header ${VDBSYNTH_PUBLIC_HEADERS})
  cmake_path(GET header PARENT_PATH room)
  install(FILES libvdbsynth/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/libvdbsynth/${room})
endforeach()
configure_package_config_file(cmake/vdbsynthConfig.cmake.in ${PROJECT_BINARY_DIR}/vdbsynthConfig.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vdbsynth)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/vdbsynthConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/vdbsynthConfig.cmake ${PROJECT_BINARY_DIR}/vdbsynthConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/vdbsynth)

# The Python module, a package of its own: `cmake --install --component python`. Debian's python3 looks there below /usr.
if(VDBSYNTH_PYTHON)
  set(VDBSYNTH_PYTHON_DESTINATION lib/python3/dist-packages CACHE STRING "Folder below the prefix that the Python module is installed into")
  install(TARGETS vdbsynth_python LIBRARY DESTINATION ${VDBSYNTH_PYTHON_DESTINATION}/vdbsynth COMPONENT python)
  install(FILES python/vdbsynth/__init__.py python/vdbsynth/__init__.pyi python/vdbsynth/py.typed
          DESTINATION ${VDBSYNTH_PYTHON_DESTINATION}/vdbsynth COMPONENT python)
endif()
