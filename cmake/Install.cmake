# cmake --install: the program, the stages as static libraries with their public headers, what find_package(Aeroloom)
# reads, manual pages, completion, cases and documentation. Of the program's own folder, pipeline/, all but the commands are
# libraries for others; few of their headers are.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

get_property(libraries GLOBAL PROPERTY AEROLOOM_LIBRARIES)
list(REMOVE_ITEM libraries aeroloom_pipeline_commands)
foreach(library IN LISTS libraries)
  install(TARGETS ${library} EXPORT AeroloomTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/aeroloom)
endforeach()
install(TARGETS aeroloom RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})

# Completion for bash, printed by the program itself.
set(completion ${CMAKE_BINARY_DIR}/completion/aeroloom)
install(CODE "
  file(MAKE_DIRECTORY \"${CMAKE_BINARY_DIR}/completion\")
  execute_process(COMMAND \"$<TARGET_FILE:aeroloom>\" completion bash OUTPUT_FILE \"${completion}\"
    COMMAND_ERROR_IS_FATAL ANY)")
install(FILES ${completion} DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)

# Manual pages, made of what the program says of itself.
set(manual ${CMAKE_BINARY_DIR}/manual)
install(CODE "
  execute_process(COMMAND \"${Python3_EXECUTABLE}\" \"${CMAKE_SOURCE_DIR}/scripts/man_pages.py\" \"$<TARGET_FILE:aeroloom>\"
    \"${manual}\" COMMAND_ERROR_IS_FATAL ANY)")
install(DIRECTORY ${manual}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)

# Cases that run as they stand, and the documentation, whose pages name each other as in the source tree.
file(GLOB cases CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/configs/*.yaml)
install(FILES ${cases} DESTINATION ${CMAKE_INSTALL_DATADIR}/aeroloom/configs)
install(FILES README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs examples DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY benchmarks/results DESTINATION ${CMAKE_INSTALL_DOCDIR}/benchmarks)

# The copyright file of a Debian package holds the licence in full, paragraphs apart by a dot.
file(READ LICENSE licence)
string(REGEX REPLACE "\n" "\n " licence "\n${licence}")
string(REGEX REPLACE "\n *\n" "\n .\n" licence "${licence}")
string(REGEX REPLACE "\n *\n" "\n .\n" licence "${licence}")
string(STRIP "${licence}" licence)
file(READ packaging/copyright copyright)
file(GENERATE OUTPUT ${CMAKE_BINARY_DIR}/copyright CONTENT "${copyright} ${licence}\n")
install(FILES ${CMAKE_BINARY_DIR}/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/Aeroloom)
install(EXPORT AeroloomTargets NAMESPACE Aeroloom:: DESTINATION ${package_folder})
configure_package_config_file(cmake/AeroloomConfig.cmake.in ${CMAKE_BINARY_DIR}/AeroloomConfig.cmake
  INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/AeroloomConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/AeroloomConfig.cmake ${CMAKE_BINARY_DIR}/AeroloomConfigVersion.cmake
  DESTINATION ${package_folder})
