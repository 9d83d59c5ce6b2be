# The installation of all files beside the programs, and the package for find_package(saphira): with it
# an agent (agents/examples) or a plug-in of behaviors (services/behaviors/examples) needs only this
# project's installed tree.
include(CMakePackageConfigHelpers)

# As packages have it (cmake/Package.cmake): what runs, what one builds with, what one reads.
set(saphira_dev COMPONENT dev)
set(saphira_doc COMPONENT doc)

# Worlds, robots, deployments: the programs look for them beside themselves.
install(DIRECTORY ${CMAKE_SOURCE_DIR}/config/ DESTINATION ${CMAKE_INSTALL_DATADIR}/saphira)
install(FILES ${CMAKE_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/saphira)
# For people: the README and the documents that it leads to, and agents to begin with.
install(FILES ${CMAKE_SOURCE_DIR}/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR} ${saphira_doc})
install(DIRECTORY ${CMAKE_SOURCE_DIR}/docs DESTINATION ${CMAKE_INSTALL_DOCDIR} ${saphira_doc})
install(DIRECTORY ${CMAKE_SOURCE_DIR}/agents/examples/
        DESTINATION ${CMAKE_INSTALL_DATADIR}/saphira/examples/agents ${saphira_doc})
install(DIRECTORY ${CMAKE_SOURCE_DIR}/services/behaviors/examples/
        DESTINATION ${CMAKE_INSTALL_DATADIR}/saphira/examples/behaviors ${saphira_doc})

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
  install(TARGETS ${targets} EXPORT saphira-${name} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} ${saphira_dev})
  install(EXPORT saphira-${name} NAMESPACE saphira:: FILE saphira-${name}-targets.cmake
          DESTINATION ${saphira_package_dir} ${saphira_dev})
endfunction()

foreach(folder services/common/base services/common/geometry services/common/requests services/common/lps services/behaviors)
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/${folder}/include/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} ${saphira_dev})
endforeach()
# The contract's types are plain C++: libraries without the bus have them, too.
install(DIRECTORY ${CMAKE_BINARY_DIR}/idl/generated/
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} ${saphira_dev} PATTERN "*.json" EXCLUDE PATTERN "*.py" EXCLUDE)
saphira_component(base base idl)
saphira_component(behaviors geometry requests lps behaviors)

if(SAPHIRA_WITH_DDS)
  install(DIRECTORY ${CMAKE_SOURCE_DIR}/idl/bus/include/ ${CMAKE_SOURCE_DIR}/idl/include/
                    ${CMAKE_SOURCE_DIR}/services/common/command_line/include/
          DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} ${saphira_dev})
  # The contract itself, for agents in other languages and of other vendors: the types, also as JSON
  # Schema, the topics with the name of each one's QoS, and the README with the table of QoS and the
  # rule of partitions.
  file(GLOB saphira_contract CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/idl/*.idl)
  install(FILES ${saphira_contract} ${CMAKE_SOURCE_DIR}/idl/README.md
                ${CMAKE_SOURCE_DIR}/idl/bus/include/saphira/bus/topics.def
                ${CMAKE_BINARY_DIR}/idl/generated/saphira/idl/schema.json
                ${CMAKE_BINARY_DIR}/idl/generated/saphira/idl/contract.md
          DESTINATION ${CMAKE_INSTALL_DATADIR}/saphira/idl ${saphira_dev})
  saphira_component(bus security command_line bus)
endif()

configure_package_config_file(${CMAKE_SOURCE_DIR}/cmake/saphira-config.cmake.in
  ${CMAKE_BINARY_DIR}/saphira-config.cmake INSTALL_DESTINATION ${saphira_package_dir})
# Before 1.0 a minor version may change the contract.
write_basic_package_version_file(${CMAKE_BINARY_DIR}/saphira-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/saphira-config.cmake
              ${CMAKE_BINARY_DIR}/saphira-config-version.cmake
        DESTINATION ${saphira_package_dir} ${saphira_dev})

# Last: what is installed has no debug information. It is in the build folder; a debugger takes it from there.
option(SAPHIRA_STRIP "Install programs and libraries without debug information" ON)
if(SAPHIRA_STRIP AND CMAKE_STRIP)
  function(saphira_strip component pattern)
    install(CODE "
      file(GLOB stripped \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${pattern}\")
      execute_process(COMMAND ${CMAKE_STRIP} ${ARGN} \${stripped} COMMAND_ERROR_IS_FATAL ANY)"
      COMPONENT ${component})
  endfunction()
  saphira_strip(core "${CMAKE_INSTALL_BINDIR}/saphira*" --remove-section=.comment --remove-section=.note)
  if(TARGET saphira-speech)
    saphira_strip(speech "${CMAKE_INSTALL_BINDIR}/saphira-speech" --remove-section=.comment --remove-section=.note)
  endif()
  if(TARGET saphira_python)
    saphira_strip(python "lib/python3/dist-packages/saphira/*.so" --strip-unneeded --remove-section=.comment --remove-section=.note)
  endif()
  saphira_strip(dev "${CMAKE_INSTALL_LIBDIR}/libsaphira_*.a" --strip-debug)
  if(TARGET sfx)
    saphira_strip(dev "${CMAKE_INSTALL_LIBDIR}/saphira/libsfx*.so" --strip-unneeded --remove-section=.comment --remove-section=.note)
  endif()
endif()

include(Package)
