# Install, export and packages: libraries with their headers, the command line with man page and completions, the examples.
include(CMakePackageConfigHelpers)

set(catoptra_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/catoptra)
foreach(folder cad_import tessellate optics render app)
  install(TARGETS catoptra_${folder} EXPORT catoptraTargets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
          FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/catoptra)
endforeach()
install(EXPORT catoptraTargets NAMESPACE catoptra:: DESTINATION ${catoptra_package_dir})

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/catoptraConfig.cmake.in ${PROJECT_BINARY_DIR}/catoptraConfig.cmake
                              INSTALL_DESTINATION ${catoptra_package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/catoptraConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/catoptraConfig.cmake ${PROJECT_BINARY_DIR}/catoptraConfigVersion.cmake
        DESTINATION ${catoptra_package_dir})

install(TARGETS catoptra RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
# The command line writes its own manual page and shell completions, so that they cannot fall behind it.
set(catoptra_generated ${PROJECT_BINARY_DIR}/share)
file(MAKE_DIRECTORY ${catoptra_generated})
add_custom_command(OUTPUT ${catoptra_generated}/catoptra.1 COMMAND catoptra man > ${catoptra_generated}/catoptra.1 VERBATIM)
set(catoptra_generated_files ${catoptra_generated}/catoptra.1)
foreach(shell bash zsh fish)
  add_custom_command(OUTPUT ${catoptra_generated}/completion.${shell}
                     COMMAND catoptra completion ${shell} > ${catoptra_generated}/completion.${shell} VERBATIM)
  list(APPEND catoptra_generated_files ${catoptra_generated}/completion.${shell})
endforeach()
add_custom_target(catoptra_command_line_help ALL DEPENDS ${catoptra_generated_files})
install(FILES ${catoptra_generated}/catoptra.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${catoptra_generated}/completion.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME catoptra)
install(FILES ${catoptra_generated}/completion.zsh DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions RENAME _catoptra)
install(FILES ${catoptra_generated}/completion.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d RENAME catoptra.fish)

install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY ${PROJECT_BINARY_DIR}/examples/ DESTINATION ${CMAKE_INSTALL_DATADIR}/catoptra/examples
        FILES_MATCHING PATTERN "*.toml" PATTERN "*.glb" PATTERN "*.step"
        PATTERN CMakeFiles EXCLUDE PATTERN programs EXCLUDE)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/app/rules/ DESTINATION ${CMAKE_INSTALL_DATADIR}/catoptra/rules
        FILES_MATCHING PATTERN "*.toml")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME catoptra)
set(CPACK_PACKAGE_CONTACT "Catoptra maintainers <maintainers@catoptra.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# A software OpenGL is found at run time, so that no linked library names it.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libgl1-mesa-dri, libegl1")
# For the Python package and its batches on a cluster.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-numpy, python3-distributed")
set(CPACK_SOURCE_IGNORE_FILES "/\\\\.git/;/build.*/;/out/")
include(CPack)
