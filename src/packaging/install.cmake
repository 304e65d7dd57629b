# Installs the libraries, headers, the CMake package mcdbn (components kernels, machines, mcdbn) and a
# pkg-config file of the whole.
set(MCDBN_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/mcdbn)

foreach(component kernels machines mcdbn)
  install(TARGETS mcdbn_library_${component} EXPORT mcdbn-${component}-targets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(EXPORT mcdbn-${component}-targets NAMESPACE mcdbn:: DESTINATION ${MCDBN_PACKAGE_DIR})
endforeach()
install(DIRECTORY include/mcdbn DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

configure_package_config_file(src/packaging/mcdbn-config.cmake.in
                              ${CMAKE_BINARY_DIR}/generated/mcdbn-config.cmake
                              INSTALL_DESTINATION ${MCDBN_PACKAGE_DIR})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/generated/mcdbn-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/generated/mcdbn-config.cmake
              ${CMAKE_BINARY_DIR}/generated/mcdbn-config-version.cmake
        DESTINATION ${MCDBN_PACKAGE_DIR})

# A static library leaves its own dependencies to the program that links it.
set(dependencies "opencv4 clblast fmt spdlog tomlplusplus")
set(libraries " -lceres")  # has no pkg-config file
if(BUILD_SHARED_LIBS)
  set(MCDBN_PC_REQUIRES "eigen3 nlohmann_json OpenCL")
  set(MCDBN_PC_REQUIRES_PRIVATE "${dependencies}")
  set(MCDBN_PC_LIBS "")
  set(MCDBN_PC_LIBS_PRIVATE "${libraries}")
else()
  set(MCDBN_PC_REQUIRES "eigen3 nlohmann_json OpenCL ${dependencies}")
  set(MCDBN_PC_REQUIRES_PRIVATE "")
  set(MCDBN_PC_LIBS "${libraries}")
  set(MCDBN_PC_LIBS_PRIVATE "")
endif()
# Relative, so that the installed tree may be moved.
file(RELATIVE_PATH MCDBN_PREFIX_FROM_PC /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
configure_file(src/packaging/mcdbn.pc.in ${CMAKE_BINARY_DIR}/generated/mcdbn.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/generated/mcdbn.pc
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
