# What is installed beside the programs, and the package that find_package(saphira) finds: with it
# an agent needs this project's installed tree alone (agents/examples/go_there).
include(CMakePackageConfigHelpers)

# Worlds, robots, deployments: the programs look for them beside themselves.
install(DIRECTORY ${CMAKE_SOURCE_DIR}/config/ DESTINATION ${CMAKE_INSTALL_DATADIR}/saphira)
install(FILES ${CMAKE_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/saphira)

if(SAPHIRA_WITH_DDS)
  # The generated headers include each other by their bare names, such as "robot.h": a folder of
  # their own keeps them out of everybody's way.
  set(saphira_generated_dir ${CMAKE_INSTALL_INCLUDEDIR}/saphira/generated)
  set(saphira_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/saphira)

  install(DIRECTORY ${CMAKE_SOURCE_DIR}/idl/bus/include/ ${CMAKE_SOURCE_DIR}/services/base/include/
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(DIRECTORY ${CMAKE_BINARY_DIR}/idl/generated/ DESTINATION ${saphira_generated_dir}
          FILES_MATCHING PATTERN "*.h" PATTERN "tmp" EXCLUDE)
  # The contract itself, for agents in other languages and of other vendors.
  file(GLOB saphira_contract CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/idl/*.idl)
  install(FILES ${saphira_contract} DESTINATION ${CMAKE_INSTALL_DATADIR}/saphira/idl)

  target_include_directories(saphira_idl SYSTEM INTERFACE
    $<INSTALL_INTERFACE:${saphira_generated_dir}>)
  target_include_directories(saphira_base INTERFACE
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_include_directories(saphira_bus INTERFACE
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(saphira_bus INTERFACE cxx_std_20)
  foreach(library idl base bus)
    set_target_properties(saphira_${library} PROPERTIES EXPORT_NAME ${library})
  endforeach()
  install(TARGETS saphira_idl saphira_base saphira_bus EXPORT saphira
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(EXPORT saphira NAMESPACE saphira:: FILE saphira-targets.cmake
          DESTINATION ${saphira_package_dir})
  configure_package_config_file(${CMAKE_SOURCE_DIR}/cmake/saphira-config.cmake.in
    ${CMAKE_BINARY_DIR}/saphira-config.cmake INSTALL_DESTINATION ${saphira_package_dir})
  # Before 1.0 a minor version may change the contract.
  write_basic_package_version_file(${CMAKE_BINARY_DIR}/saphira-config-version.cmake
    COMPATIBILITY SameMinorVersion)
  install(FILES ${CMAKE_BINARY_DIR}/saphira-config.cmake
                ${CMAKE_BINARY_DIR}/saphira-config-version.cmake
          DESTINATION ${saphira_package_dir})
endif()
