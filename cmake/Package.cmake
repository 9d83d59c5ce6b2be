# Debian packages, by `./saphira package`: saphira (programs, their configuration, a systemd unit),
# saphira-speech, python3-saphira, saphira-dev (to build agents and behaviors with, and the contract) and saphira-doc. The
# programs are one package: together they take less room than the libraries that each of them needs, and
# programs of one version fit together. Hearing and voice are their own, for their 80 MB of models.
if(NOT SAPHIRA_WITH_DDS)
  return()
endif()
set(package ${CMAKE_SOURCE_DIR}/cmake/package)
set(packed ${CMAKE_BINARY_DIR}/package)

install(FILES ${package}/saphira@.service ${package}/saphira-relay.service DESTINATION lib/systemd/system)
install(FILES ${package}/saphira.conf DESTINATION lib/sysusers.d)

# Manual pages, made of what the programs say to --help. help2man is looked for when packages are made.
add_custom_target(saphira_man
  COMMAND ${package}/man ${CMAKE_BINARY_DIR}/bin ${packed}/man
  DEPENDS saphira_programs VERBATIM)
install(DIRECTORY ${packed}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 OPTIONAL FILES_MATCHING
        PATTERN "*.1.gz" PATTERN "saphira-speech.1.gz" EXCLUDE)
install(FILES ${packed}/man/saphira-speech.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1
        COMPONENT speech OPTIONAL)

# Debian's policy requires a copyright file and a changelog in each package.
set(components core dev doc)
if(TARGET saphira-speech)
  list(APPEND components speech)
endif()
if(TARGET saphira_python)
  list(APPEND components python)
endif()
foreach(component ${components})
  string(REPLACE core "" suffix ${component})
  string(REGEX REPLACE "(.+)" "-\\1" suffix "${suffix}")
  set(name saphira${suffix})
  if(component STREQUAL python)
    set(name python3-saphira)
  endif()
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
  install(FILES ${packed}/copyright ${packed}/changelog.gz DESTINATION share/doc/${name}
          COMPONENT ${component} OPTIONAL)
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME saphira)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "control of mobile robots over a DDS bus")
set(CPACK_PACKAGE_CONTACT "Saphira on DDS <saphira@saphira.invalid>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${packed})
set(CPACK_COMPONENTS_ALL ${components})
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_STRIP_FILES OFF)  # cmake/Install.cmake does that

set(CPACK_DEBIAN_CORE_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_CORE_PACKAGE_DEPENDS "adduser")
set(CPACK_DEBIAN_CORE_PACKAGE_RECOMMENDS "bash-completion")
set(CPACK_DEBIAN_CORE_PACKAGE_SUGGESTS "chromium, saphira-doc")
set(CPACK_DEBIAN_CORE_PACKAGE_CONTROL_EXTRA "${package}/postinst;${package}/prerm;${package}/postrm")
set(CPACK_DEBIAN_CORE_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_COMPONENT_CORE_DESCRIPTION
  "Programs that control a mobile robot: a bridge to its controller, a
simulator, interpretation of sonars and cameras, maps and registration,
behaviors, intentions, a dialogue, a page for the browser and a command
line. They talk over a DDS bus, on one machine or on several.")
set(CPACK_DEBIAN_SPEECH_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_SPEECH_PACKAGE_DEPENDS "saphira (= ${PROJECT_VERSION}), pocketsphinx-en-us")
set(CPACK_DEBIAN_SPEECH_PACKAGE_SUGGESTS "alsa-utils, espeak-ng")
set(CPACK_COMPONENT_SPEECH_DESCRIPTION
  "What people say to the robot by voice, and the robot's own voice: one
more program on the bus, for the sound card of this machine.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.11), python3 (<< 3.12), python3-numpy")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "saphira, jupyter-notebook, python3-matplotlib")
# Removes the byte code that the interpreter has written beside the modules.
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA "${package}/python/prerm")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_COMPONENT_PYTHON_DESCRIPTION
  "Agents for robots of Saphira in Python: programs that watch a robot, send
it, ask others and can be asked, or drive. With types for mypy, and with or
without asyncio.")
set(CPACK_DEBIAN_DEV_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "saphira (= ${PROJECT_VERSION}), libfastrtps-dev, libeigen3-dev, libspdlog-dev, libssl-dev, libutf8proc-dev, libyaml-cpp-dev")
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_DEV_DESCRIPTION
  "Headers and static libraries for programs that join the bus of Saphira and
for behaviors in C++, and the contract: the IDL files with every type and
topic, for other languages and other vendors of DDS.")
set(CPACK_DEBIAN_DOC_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_DOC_PACKAGE_SECTION doc)
set(CPACK_COMPONENT_DOC_DESCRIPTION
  "How the programs of Saphira work together, how to add a behavior, an
activity, a robot or an agent, and examples of agents and behaviors.")
include(CPack)
