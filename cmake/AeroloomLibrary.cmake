# Most of the time of a compiler goes into headers, the same ones for every source, so several sources make one
# unit. Names in anonymous namespaces are therefore unique within a library. 1: each source on its own.
set(AEROLOOM_SOURCES_AT_ONCE 8 CACHE STRING "Sources of a folder that are compiled together")
function(aeroloom_compile_at_once target)
  if(AEROLOOM_SOURCES_AT_ONCE GREATER 1)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${AEROLOOM_SOURCES_AT_ONCE})
  endif()
endfunction()

# One folder, one library: aeroloom_library(<folder> SOURCES ... ALONE ... HEADERS ... PUBLIC ... PRIVATE ...).
# <folder> is a path from the root, as mesh or mesh/data; the library is aeroloom_mesh, aeroloom_mesh_data. Sources and
# headers are named within the folder. HEADERS are those of host programs, installed under aeroloom/; they include no others.
# PUBLIC and PRIVATE name libraries. Sources are compiled several at a time, in the order
# given (AEROLOOM_SOURCES_AT_ONCE), but those of ALONE: dear ones, or ones whose third-party headers leave macros behind. A
# folder whose sources all lie in its sub-folders has an interface library, which links theirs.
function(aeroloom_library folder)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE;ALONE;HEADERS" ${ARGN})
  string(REPLACE / _ name ${folder})
  set(library aeroloom_${name})
  set_property(GLOBAL APPEND PROPERTY AEROLOOM_LIBRARIES ${library})
  foreach(list IN ITEMS SOURCES ALONE HEADERS)
    list(TRANSFORM ARG_${list} PREPEND ${CMAKE_SOURCE_DIR}/${folder}/)
  endforeach()
  if(NOT ARG_SOURCES AND NOT ARG_ALONE)
    add_library(${library} INTERFACE)
    target_sources(${library} INTERFACE FILE_SET HEADERS BASE_DIRS ${CMAKE_SOURCE_DIR} FILES ${ARG_HEADERS})
    target_link_libraries(${library} INTERFACE ${ARG_PUBLIC})
    set_target_properties(${library} PROPERTIES EXPORT_NAME ${name})
    return()
  endif()
  add_library(${library} STATIC ${ARG_SOURCES} ${ARG_ALONE})
  aeroloom_compile_at_once(${library})
  if(ARG_ALONE)
    set_source_files_properties(${ARG_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
  set_target_properties(${library} PROPERTIES EXPORT_NAME ${name})
  target_sources(${library} PUBLIC FILE_SET HEADERS BASE_DIRS ${CMAKE_SOURCE_DIR} FILES ${ARG_HEADERS})
  # Host programs write <aeroloom/mesh/data/piece.hpp>, the headers themselves "mesh/data/piece.hpp".
  target_include_directories(${library} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}> $<INSTALL_INTERFACE:include> $<INSTALL_INTERFACE:include/aeroloom>)
  target_compile_features(${library} PUBLIC cxx_std_20)
  # One mesh on every machine: no contraction into fused multiply-add, no value-changing optimisation. Headers
  # compute too, so the flags travel with the target.
  target_compile_options(${library} PUBLIC -ffp-contract=off -fno-fast-math)
  target_link_libraries(${library} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
endfunction()

# aeroloom_test_program(<name> LIBRARIES ... [FAST]): the test program of a folder. FAST: built by the target
# fast_tests; scripts/check.sh runs its entries labelled `fast` under sanitizers.
add_custom_target(fast_tests)
function(aeroloom_test_program name)
  cmake_parse_arguments(ARG "FAST" "" "LIBRARIES" ${ARGN})
  if(NOT TARGET aeroloom_test_main)  # compiled once for all
    set(tests ${CMAKE_SOURCE_DIR}/tests)
    add_library(aeroloom_test_main STATIC ${tests}/test_main.cpp ${tests}/source_tree.cpp ${tests}/references.cpp)
    set_source_files_properties(${tests}/source_tree.cpp TARGET_DIRECTORY aeroloom_test_main
      PROPERTIES COMPILE_DEFINITIONS AEROLOOM_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
    target_include_directories(aeroloom_test_main PUBLIC ${CMAKE_SOURCE_DIR})
    target_link_libraries(aeroloom_test_main PUBLIC aeroloom_parallel GTest::gtest)
  endif()
  add_executable(${name})
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/tests)
  target_link_libraries(${name} PRIVATE aeroloom_test_main ${ARG_LIBRARIES})
  if(ARG_FAST)
    add_dependencies(fast_tests ${name})
    set_target_properties(${name} PROPERTIES AEROLOOM_FAST TRUE)
  endif()
endfunction()

# aeroloom_test(<room>_test[.<part>] FILES ... RANKS 1 2 3 [ALSO_ON ranks file ...] [TIMEOUT seconds]
#   [REFERENCES] [FAST])
# adds the sources <file>_test.cpp, which lie in the folder or a sub-folder, to a test program, and registers what they define
# once per rank count, as <room>.<part>.n<ranks>. What a test needs stands in the test: suites named `...Local` run on one rank
# alone, and tests that begin with NEEDS_SEVERAL_RANKS() (tests/several_ranks.hpp) on more. ALSO_ON: these of the files are worth
# one more count. REFERENCES: tests on more ranks compare with what the entry on one has kept (tests/references.hpp), which runs
# before them. FAST: labelled `fast`, on one and three ranks.
function(aeroloom_test name)
  cmake_parse_arguments(ARG "FAST;REFERENCES" "TIMEOUT" "FILES;RANKS;ALSO_ON" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 600)
  endif()
  string(REGEX REPLACE "\\..*" "" program ${name})
  string(REGEX REPLACE "_test(\\.|$)" "\\1" entry ${name})
  get_target_property(built_fast ${program} AEROLOOM_FAST)
  if(ARG_FAST AND NOT built_fast)
    message(FATAL_ERROR "${name} is FAST, but its program ${program} is not: sanitizers would look for it in vain")
  endif()
  list(TRANSFORM ARG_FILES APPEND _test)
  foreach(file IN LISTS ARG_FILES)
    file(GLOB source CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${file}.cpp ${CMAKE_CURRENT_SOURCE_DIR}/*/${file}.cpp)
    list(LENGTH source found)
    if(NOT found EQUAL 1)
      message(FATAL_ERROR "${name}: ${file}.cpp is there ${found} times")
    endif()
    target_sources(${program} PRIVATE ${source})
    file(STRINGS ${source} local REGEX "^TEST(_[FP])?\\([A-Za-z]*Local,")
    if(local AND NOT 1 IN_LIST ARG_RANKS)
      message(FATAL_ERROR "${name} leaves out what runs on one rank alone: ${local}")
    endif()
  endforeach()
  set(also_on 0)
  if(ARG_ALSO_ON)
    list(POP_FRONT ARG_ALSO_ON also_on)
    list(TRANSFORM ARG_ALSO_ON APPEND _test)
    list(APPEND ARG_RANKS ${also_on})
  endif()
  foreach(ranks IN LISTS ARG_RANKS)
    set(files ${ARG_FILES})
    if(ranks EQUAL also_on)
      set(files ${ARG_ALSO_ON})
    endif()
    list(JOIN files , files)
    add_test(NAME ${entry}.n${ranks} COMMAND ${AEROLOOM_MPIRUN} ${ranks} $<TARGET_FILE:${program}> --files=${files})
    # Two cores at most: ranks that share cores yield theirs while they wait. What takes one core comes first (COST): two
    # of them side by side leave none idle.
    set(cores 2)
    set(cost 1)
    if(ranks EQUAL 1)
      set(cores 1)
      set(cost 100)
    endif()
    set_tests_properties(${entry}.n${ranks} PROPERTIES PROCESSORS ${cores} COST ${cost} TIMEOUT ${ARG_TIMEOUT})
    if(ARG_REFERENCES)
      set(fixture FIXTURES_REQUIRED)
      if(ranks EQUAL 1)
        set(fixture FIXTURES_SETUP)
      endif()
      set_tests_properties(${entry}.n${ranks} PROPERTIES ${fixture} ${entry}
        ENVIRONMENT AEROLOOM_REFERENCES=${CMAKE_BINARY_DIR}/tests/references)
    endif()
    if(ARG_FAST AND (ranks EQUAL 1 OR ranks EQUAL 3))
      set_tests_properties(${entry}.n${ranks} PROPERTIES LABELS fast)
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
