# Most of the time of a compiler goes into headers, the same ones for every source, so several sources make one
# unit. Names in anonymous namespaces are therefore unique within a folder. 1: each source on its own.
set(AEROLOOM_SOURCES_AT_ONCE 8 CACHE STRING "Sources of a folder that are compiled together")
function(aeroloom_compile_at_once target)
  if(AEROLOOM_SOURCES_AT_ONCE GREATER 1)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${AEROLOOM_SOURCES_AT_ONCE})
  endif()
endfunction()

# One folder, one library, one namespace: aeroloom_library(<folder> SOURCES ... PUBLIC ... PRIVATE ...
# ALONE ...). PUBLIC and PRIVATE name libraries; a library of another folder is written aeroloom_<folder>.
# Sources are compiled several at a time, in the order given (AEROLOOM_SOURCES_AT_ONCE), but those of ALONE:
# dear ones, or ones whose third-party headers leave macros behind.
function(aeroloom_library folder)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE;ALONE" ${ARGN})
  add_library(aeroloom_${folder} STATIC ${ARG_SOURCES} ${ARG_ALONE})
  aeroloom_compile_at_once(aeroloom_${folder})
  if(ARG_ALONE)
    set_source_files_properties(${ARG_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
  set_target_properties(aeroloom_${folder} PROPERTIES EXPORT_NAME ${folder})
  target_include_directories(aeroloom_${folder} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}>
    $<INSTALL_INTERFACE:include> $<INSTALL_INTERFACE:include/aeroloom>)
  target_compile_features(aeroloom_${folder} PUBLIC cxx_std_20)
  # One mesh on every machine: no contraction into fused multiply-add, no value-changing optimisation. Headers
  # compute too, so the flags travel with the target.
  target_compile_options(aeroloom_${folder} PUBLIC -ffp-contract=off -fno-fast-math)
  target_link_libraries(aeroloom_${folder} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
endfunction()

# aeroloom_test(<name> SOURCES ... LIBRARIES ... RANKS 1 2 3 [TIMEOUT seconds] [FAST])
# builds one test program and registers it once per rank count, as <name>.n<ranks>. FAST: built by the target
# fast_tests and labelled `fast`; scripts/check.sh runs those under sanitizers.
add_custom_target(fast_tests)
function(aeroloom_test name)
  cmake_parse_arguments(ARG "FAST" "TIMEOUT" "SOURCES;LIBRARIES;RANKS" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  if(NOT TARGET aeroloom_test_main)  # compiled once for all
    add_library(aeroloom_test_main STATIC ${CMAKE_SOURCE_DIR}/tests/test_main.cpp)
    target_include_directories(aeroloom_test_main PRIVATE ${CMAKE_SOURCE_DIR})
    target_link_libraries(aeroloom_test_main PUBLIC aeroloom_parallel GTest::gtest)
  endif()
  add_executable(${name} ${ARG_SOURCES})
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  target_compile_definitions(${name} PRIVATE
    AEROLOOM_SOURCE_DIR="${CMAKE_SOURCE_DIR}" AEROLOOM_PROGRAM="${CMAKE_BINARY_DIR}/bin/aeroloom")
  target_include_directories(${name} PRIVATE ${CMAKE_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE aeroloom_test_main ${ARG_LIBRARIES})
  if(ARG_FAST)
    add_dependencies(fast_tests ${name})
  endif()
  foreach(ranks IN LISTS ARG_RANKS)
    add_test(NAME ${name}.n${ranks} COMMAND ${AEROLOOM_MPIRUN} ${ranks} $<TARGET_FILE:${name}>)
    set_tests_properties(${name}.n${ranks} PROPERTIES PROCESSORS ${ranks} TIMEOUT ${ARG_TIMEOUT})
    if(ARG_FAST)
      set_tests_properties(${name}.n${ranks} PROPERTIES LABELS fast)
    endif()
  endforeach()
endfunction()

# aeroloom_benchmark(<name> SOURCES ... LIBRARIES ...)
function(aeroloom_benchmark name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/benchmarks)
  target_include_directories(${name} PRIVATE ${CMAKE_SOURCE_DIR})
  target_link_libraries(${name} PRIVATE ${ARG_LIBRARIES})
endfunction()
