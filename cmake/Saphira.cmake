# The one place that says how a library, a program and a test of this project are built.
include(GNUInstallDirs)

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE RelWithDebInfo CACHE STRING "" FORCE)
endif()
# Contraction to fused multiply-adds would let the same trajectory differ between machines.
add_compile_options(-ffp-contract=off)
# Lines for backtraces, no variables: a third less to compile. For a debugger: CMAKE_BUILD_TYPE=Debug.
# -Og: a third less to compile than -O2, for the command line, agents, mains and tests. Libraries of services, bridge,
# simulator and bus, and those that saphira_computes() names, have -O2.
add_compile_options($<$<CONFIG:RelWithDebInfo>:-g1> $<$<CONFIG:RelWithDebInfo>:-Og>)
# GCC looks for garbage in its memory less often: a tenth less to compile, for 0.2 GB.
add_compile_options("$<$<COMPILE_LANG_AND_ID:CXX,GNU>:SHELL:--param ggc-min-expand=200 --param ggc-min-heapsize=600000>")
# __FILE__ names no folder of this machine, and ccache serves one build folder with the objects of another.
add_compile_options("-fmacro-prefix-map=${CMAKE_SOURCE_DIR}/=")
# Several sources as one unit: less than half the time to compile. Off (-DCMAKE_UNITY_BUILD=OFF) each source
# shows that it includes what it uses.
set(CMAKE_UNITY_BUILD ON CACHE BOOL "Compile several sources as one unit")
set(CMAKE_UNITY_BUILD_BATCH_SIZE 12 CACHE STRING "How many")
find_program(CCACHE ccache)
if(CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE})
endif()
if(SAPHIRA_SANITIZE)
  # -O1: GCC takes twice as long with -O2, for code that is instrumented.
  add_compile_options(-O1 -fsanitize=${SAPHIRA_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${SAPHIRA_SANITIZE})
  # The environment of what is tested: faults that are Fast DDS's own.
  if(SAPHIRA_SANITIZE MATCHES address)
    # Fast DDS 2.9 deletes its statistics through a base without virtual destructor.
    set(SAPHIRA_SANITIZER_OPTIONS "ASAN_OPTIONS=new_delete_type_mismatch=0")
  elseif(SAPHIRA_SANITIZE MATCHES thread)
    set(SAPHIRA_SANITIZER_OPTIONS "TSAN_OPTIONS=suppressions=${CMAKE_SOURCE_DIR}/cmake/tsan.supp")
  endif()
  if(CMAKE_CXX_COMPILER_ID MATCHES Clang)
    # Coverage of the fuzzers.
    add_compile_options(-fsanitize=fuzzer-no-link)
  else()
    # With a sanitizer's branches in it GCC 12 takes members of an optional for uninitialized.
    add_compile_options(-Wno-maybe-uninitialized)
  endif()
endif()

# Eigen: vectors and rotations of the geometry.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(Threads REQUIRED)

if(SAPHIRA_TESTS)
  enable_testing()
  find_package(GTest REQUIRED)
  include(GoogleTest)
endif()

add_library(saphira_warnings INTERFACE)
target_compile_options(saphira_warnings INTERFACE -Wall -Wextra -Wshadow -Wconversion
  $<$<NOT:$<BOOL:$<TARGET_PROPERTY:SAPHIRA_NOT_PEDANTIC>>>:-Wpedantic>
  $<$<BOOL:${SAPHIRA_WERROR}>:-Werror>)

# saphira_computes(<name>...): libraries that work in each cycle of the robot, or at length. No program
# replaces their functions at load time: calls within a source may be inlined, as Clang does.
function(saphira_computes)
  if(NOT SAPHIRA_SANITIZE)
    foreach(name ${ARGN})
      target_compile_options(${name} PRIVATE $<$<CONFIG:RelWithDebInfo>:-O2>
                             $<$<CXX_COMPILER_ID:GNU>:-fno-semantic-interposition>)
    endforeach()
  endif()
endfunction()

# saphira_library(<name> SOURCES a.cpp... [LINK t...])
# The public headers are in include/ beside the caller. A library without SOURCES is header-only.
function(saphira_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;LINK" ${ARGN})
  if(arg_SOURCES)
    add_library(${name} STATIC ${arg_SOURCES})
    target_include_directories(${name} PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>)
    target_link_libraries(${name} PUBLIC ${arg_LINK} PRIVATE $<BUILD_INTERFACE:saphira_warnings>)
    file(RELATIVE_PATH place ${CMAKE_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
    if(place MATCHES "^(services|bridge|sim|idl)(/|$)")
      saphira_computes(${name})
    endif()
  else()
    add_library(${name} INTERFACE)
    target_include_directories(${name} INTERFACE $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>)
    target_link_libraries(${name} INTERFACE ${arg_LINK})
  endif()
endfunction()

# saphira_program(<name> SOURCES main.cpp... LINK t... [COMPONENT speech]): an executable that is
# installed, with the package core where nothing else is said.
# SAPHIRA_COMPILE_ONLY: it is compiled, and neither linked nor installed.
# The target saphira_programs builds all of them, without the tests.
add_custom_target(saphira_programs)
function(saphira_program name)
  cmake_parse_arguments(arg "" "COMPONENT" "SOURCES;LINK" ${ARGN})
  if(NOT arg_COMPONENT)
    set(arg_COMPONENT core)
  endif()
  if(SAPHIRA_COMPILE_ONLY)
    add_library(${name} OBJECT ${arg_SOURCES})
    target_link_libraries(${name} PRIVATE ${arg_LINK} saphira_warnings)
    return()
  endif()
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE ${arg_LINK} saphira_warnings)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
  add_dependencies(saphira_programs ${name})
  install(TARGETS ${name} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${arg_COMPONENT})
endfunction()

# saphira_service(<name> [SOURCES shell/a.cpp...] [LINK t...]): a cyclic service. Its library
# saphira_<name>_shell, of shell/service.cpp and SOURCES, has "<name>/shell/..." as headers and defines
# saphira::<name>::component(). Its program is saphira-<name>. The table of the system (services/system)
# has it, and so have the programs that run all services.
function(saphira_service name)
  if(NOT SAPHIRA_WITH_DDS)
    return()
  endif()
  cmake_parse_arguments(arg "" "" "SOURCES;LINK" ${ARGN})
  saphira_library(saphira_${name}_shell SOURCES shell/service.cpp ${arg_SOURCES} LINK ${arg_LINK} saphira_runtime)
  target_include_directories(saphira_${name}_shell PUBLIC ${CMAKE_CURRENT_SOURCE_DIR}/..)
  set(main ${CMAKE_CURRENT_BINARY_DIR}/${name}_main.cpp)
  file(CONFIGURE OUTPUT ${main} CONTENT [[
#include "saphira/runtime/component.hpp"

namespace saphira::@name@ {
runtime::Component component();
}

int main(int argc, char** argv) {
  return saphira::runtime::run_component(argc, argv, saphira::@name@::component());
}
]] @ONLY)
  saphira_program(saphira-${name} SOURCES ${main} LINK saphira_${name}_shell)
  if(NOT SAPHIRA_COMPILE_ONLY)
    set_property(GLOBAL APPEND PROPERTY SAPHIRA_SERVICES ${name})
  endif()
endfunction()

# Tests of whole programs, and of long drives, take minutes: `./saphira test --quick` leaves those
# labelled `slow` out.
set(SAPHIRA_SLOW_TESTS "/tests/(acceptance|bench|clients|drive|fuzz|integration|network)|/explore$|/saphira_c$")

# saphira_test(<name> SOURCES a_test.cpp... LINK t... [BUS] [LIVE filter...] [TIMEOUT s])
# Tests are exact: pure, in lockstep, or on a bus in memory with a clock that the test moves. One failure
# is a failure.
# LIVE: a filter of GoogleTest each, such as Suite.* (*: all tests). The tests that it matches run real
# processes in real time. Each filter is one case with the label `live`, and ./saphira test grants it
# three attempts. They cost minutes, so they are few.
# BUS: each run has a DDS domain of its own, on loopback; so do live tests.
function(saphira_test name)
  if(NOT SAPHIRA_TESTS)
    return()
  endif()
  cmake_parse_arguments(arg "BUS" "TIMEOUT" "SOURCES;LINK;LIVE" ${ARGN})
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 120)
  endif()
  if(SAPHIRA_SANITIZE)
    math(EXPR arg_TIMEOUT "${arg_TIMEOUT} * 5")
  endif()
  add_executable(${name} ${arg_SOURCES})
  set(main GTest::gtest_main)
  if(arg_BUS OR arg_LIVE)
    set(main saphira_test_live_main)
  endif()
  target_link_libraries(${name} PRIVATE ${arg_LINK} ${main} saphira_warnings)
  target_include_directories(${name} PRIVATE ${CMAKE_SOURCE_DIR}/tests/support)  # trouble.hpp
  # A sixth of the disk. What is tested keeps its flags.
  target_compile_options(${name} PRIVATE $<$<CONFIG:RelWithDebInfo>:-g0>)
  target_link_options(${name} PRIVATE $<$<CONFIG:RelWithDebInfo>:-Wl,--strip-debug>)
  set(environment "SAPHIRA_SOURCE_DIR=${CMAKE_SOURCE_DIR};SAPHIRA_BIN_DIR=${CMAKE_BINARY_DIR}/bin;SAPHIRA_BUILD_DIR=${CMAKE_BINARY_DIR};SAPHIRA_SECURITY=none")
  list(APPEND environment ${SAPHIRA_SANITIZER_OPTIONS})
  set(label quick)
  if(CMAKE_CURRENT_SOURCE_DIR MATCHES "${SAPHIRA_SLOW_TESTS}")
    set(label slow)
  endif()
  foreach(filter ${arg_LIVE})
    string(REPLACE "*" "" case "${name}.${filter}")
    string(REGEX REPLACE "\\.+$" "" case "${case}")
    add_test(NAME ${case} COMMAND ${name} --gtest_filter=${filter})
    set_tests_properties(${case} PROPERTIES TIMEOUT ${arg_TIMEOUT} LABELS "${label};live"
      ENVIRONMENT "${environment}" SKIP_RETURN_CODE 77)
  endforeach()
  if("${arg_LIVE}" STREQUAL "*")
    return()
  endif()
  string(REPLACE ";" ":" live "${arg_LIVE}")
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 TEST_PREFIX "${name}." NO_PRETTY_VALUES
    TEST_FILTER "-${live}" TEST_LIST ${name}_tests PROPERTIES TIMEOUT ${arg_TIMEOUT})
  # Apart, since gtest_discover_tests takes a property that is a list to pieces.
  set(setter "${CMAKE_CURRENT_BINARY_DIR}/${name}_environment.cmake")
  file(WRITE "${setter}" "if(${name}_tests)
  set_tests_properties(\${${name}_tests} PROPERTIES LABELS ${label} ENVIRONMENT \"${environment}\")\nendif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES "${setter}")
endfunction()
