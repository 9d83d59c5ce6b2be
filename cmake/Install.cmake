# What is installed beside the programs, and the package that find_package(saphira) finds: with it
# an agent (agents/examples) or a plug-in of behaviors (services/behaviors/examples) needs this
# project's installed tree alone.
include(CMakePackageConfigHelpers)

# Worlds, robots, deployments: the programs look for them beside themselves.
install(DIRECTORY ${CMAKE_SOURCE_DIR}/config/ DESTINATION ${CMAKE_INSTALL_DATADIR}/saphira)
install(FILES ${CMAKE_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/saphira)

set(saphira_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/saphira)

# saphira_component(<name> t...): the libraries that the component adds to the package, as
# saphira::<t>.
function(saphira_component name)
  foreach(library ${ARGN})
    target_compile_features(saphira_${library} INTERFACE cxx_std_20)
    target_include_directories(saphira_${library} INTERFACE
      $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
    set_target_properties(saphira_${library} PROPERTIES EXPORT_NAME ${library})
  endforeach()
  list(TRANSFORM ARGN PREPEND saphira_ OUTPUT_VARIABLE targets)
  install(TARGETS ${targets} EXPORT saphira-${name} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(EXPORT saphira-${name} NAMESPACE saphira:: FILE saphira-${name}-targets.cmake
          DESTINATION ${saphira_package_dir})
endfunction()

foreach(folder services/common/base services/common/geometry services/common/lps services/behaviors)
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/${folder}/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
endforeach()
saphira_component(base base)
saphira_component(behaviors geometry lps behaviors)

if(SAPHIRA_WITH_DDS)
  # The generated headers include each other by their bare names, such as "robot.h": a folder of
  # their own keeps them out of everybody's way.
  set(saphira_generated_dir ${CMAKE_INSTALL_INCLUDEDIR}/saphira/generated)
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/idl/bus/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(DIRECTORY ${CMAKE_BINARY_DIR}/idl/generated/ DESTINATION ${saphira_generated_dir}
          FILES_MATCHING PATTERN "*.h" PATTERN "tmp" EXCLUDE)
  # The contract itself, for agents in other languages and of other vendors.
  file(GLOB saphira_contract CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/idl/*.idl)
  install(FILES ${saphira_contract} DESTINATION ${CMAKE_INSTALL_DATADIR}/saphira/idl)
  target_include_directories(saphira_idl SYSTEM INTERFACE
    $<INSTALL_INTERFACE:${saphira_generated_dir}>)
  saphira_component(bus idl bus)
endif()

configure_package_config_file(${CMAKE_SOURCE_DIR}/cmake/saphira-config.cmake.in
  ${CMAKE_BINARY_DIR}/saphira-config.cmake INSTALL_DESTINATION ${saphira_package_dir})
# Before 1.0 a minor version may change the contract.
write_basic_package_version_file(${CMAKE_BINARY_DIR}/saphira-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/saphira-config.cmake
              ${CMAKE_BINARY_DIR}/saphira-config-version.cmake
        DESTINATION ${saphira_package_dir})
