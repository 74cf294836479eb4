# cmake --install: the program, the stages as static libraries, their headers under include/aeroloom, and what
# find_package(Aeroloom) reads. The program's own folder, pipeline/, is no library for others.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

list(REMOVE_ITEM AEROLOOM_FOLDERS pipeline)
foreach(folder IN LISTS AEROLOOM_FOLDERS)
  install(TARGETS aeroloom_${folder} EXPORT AeroloomTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY ${folder}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/aeroloom/${folder}
    FILES_MATCHING PATTERN "*.hpp")
endforeach()
install(TARGETS aeroloom RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})

# Completion for bash, printed by the program itself.
set(completion ${CMAKE_BINARY_DIR}/completion/aeroloom)
install(CODE "
  file(MAKE_DIRECTORY \"${CMAKE_BINARY_DIR}/completion\")
  execute_process(COMMAND \"$<TARGET_FILE:aeroloom>\" completion bash OUTPUT_FILE \"${completion}\"
    COMMAND_ERROR_IS_FATAL ANY)")
install(FILES ${completion} DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/Aeroloom)
install(EXPORT AeroloomTargets NAMESPACE Aeroloom:: DESTINATION ${package_folder})
configure_package_config_file(cmake/AeroloomConfig.cmake.in ${CMAKE_BINARY_DIR}/AeroloomConfig.cmake
  INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/AeroloomConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/AeroloomConfig.cmake ${CMAKE_BINARY_DIR}/AeroloomConfigVersion.cmake
  DESTINATION ${package_folder})
