# SPDX-License-Identifier: Apache-2.0
# cmake --install: the command, the library, its headers, CMake package, pkg-config file, manual,
# completions and Python module. They find each other by relative paths, so that an installed tree
# may be moved. docs/guide/install.md.
#
# The component `overcast` goes to the same places everywhere. `local` has the files that an
# installation by hand puts elsewhere than a Debian package does; `debian` has the package's
# versions of those and the files that only a package has (cmake/package.cmake).
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Overcast)

install(TARGETS overcast RUNTIME COMPONENT overcast)
install(TARGETS overcast_plugin EXPORT Overcast
    LIBRARY COMPONENT overcast NAMELINK_COMPONENT overcast
    INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
# Only the command loads it, so it lies in a folder of its own.
install(TARGETS overcast_thesis
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/overcast COMPONENT overcast)
# tachyon with Overcast in it, where it is built. Only overcast-tachyon preloads the module.
if(TARGET overcast_tachyon)
    install(TARGETS overcast-tachyon RUNTIME COMPONENT overcast)
    install(TARGETS overcast_tachyon
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/overcast COMPONENT overcast)
endif()
install(FILES plugin/overcast.h plugin/overcast.hpp
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/overcast COMPONENT overcast)

install(FILES plugin/examples/hills.c plugin/examples/sunlit.cpp
    DESTINATION ${CMAKE_INSTALL_DOCDIR}/examples COMPONENT overcast)

# find_package(Overcast): the target Overcast::overcast
set_target_properties(overcast_plugin PROPERTIES EXPORT_NAME overcast)
install(EXPORT Overcast NAMESPACE Overcast:: FILE OvercastTargets.cmake
    DESTINATION ${package_dir} COMPONENT overcast)
configure_package_config_file(
    cmake/OvercastConfig.cmake.in ${PROJECT_BINARY_DIR}/OvercastConfig.cmake
    INSTALL_DESTINATION ${package_dir} PATH_VARS CMAKE_INSTALL_LIBDIR
    NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/OvercastConfigVersion.cmake
    COMPATIBILITY SameMajorVersion)
install(
    FILES ${PROJECT_BINARY_DIR}/OvercastConfig.cmake
          ${PROJECT_BINARY_DIR}/OvercastConfigVersion.cmake
    DESTINATION ${package_dir} COMPONENT overcast)

# pkg-config overcast
file(RELATIVE_PATH OVC_PREFIX_FROM_PC
    ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
string(REGEX REPLACE "/$" "" OVC_PREFIX_FROM_PC ${OVC_PREFIX_FROM_PC})
configure_file(cmake/overcast.pc.in ${PROJECT_BINARY_DIR}/overcast.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/overcast.pc
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT overcast)

# The command writes its manual page and completions itself.
set(words ${PROJECT_BINARY_DIR}/words)
find_program(OVC_GZIP gzip REQUIRED)
add_custom_command(
    OUTPUT ${words}/overcast.1.gz ${words}/overcast.bash ${words}/_overcast ${words}/overcast.fish
    COMMAND ${CMAKE_COMMAND} -E make_directory ${words}
    COMMAND overcast man > ${words}/overcast.1
    COMMAND ${OVC_GZIP} -9nf ${words}/overcast.1
    COMMAND overcast completion bash > ${words}/overcast.bash
    COMMAND overcast completion zsh > ${words}/_overcast
    COMMAND overcast completion fish > ${words}/overcast.fish
    DEPENDS overcast VERBATIM)
add_custom_command(OUTPUT ${words}/overcast-tachyon.1.gz
    COMMAND ${CMAKE_COMMAND} -E make_directory ${words}
    COMMAND ${OVC_GZIP} -9nc ${PROJECT_SOURCE_DIR}/plugin/hosts/tachyon/overcast-tachyon.1
            > ${words}/overcast-tachyon.1.gz
    DEPENDS plugin/hosts/tachyon/overcast-tachyon.1 VERBATIM)
set(manuals
    ${words}/overcast.1.gz $<$<TARGET_EXISTS:overcast_tachyon>:${words}/overcast-tachyon.1.gz>)
add_custom_target(overcast_words ALL DEPENDS ${manuals})
install(FILES ${manuals} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT overcast)
install(FILES ${words}/overcast.bash RENAME overcast
    DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT overcast)
install(FILES ${words}/overcast.fish
    DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d COMPONENT overcast)
install(FILES ${words}/_overcast
    DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions COMPONENT local)
install(FILES ${words}/_overcast
    DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT debian EXCLUDE_FROM_ALL)

# ovc_install_python(FOLDER COMPONENT …): installs the module, with the relative path from it to the
# library.
function(ovc_install_python folder)
    file(RELATIVE_PATH OVC_LIBRARY_FOLDER
        ${CMAKE_INSTALL_PREFIX}/${folder}/overcast ${CMAKE_INSTALL_FULL_LIBDIR})
    string(MAKE_C_IDENTIFIER ${folder} name)
    set(built ${PROJECT_BINARY_DIR}/python_built/${name}/_built.py)
    configure_file(plugin/python/built.py.in ${built} @ONLY)
    install(DIRECTORY plugin/python/overcast DESTINATION ${folder} ${ARGN}
        FILES_MATCHING PATTERN "*.py" PATTERN "py.typed" PATTERN "__pycache__" EXCLUDE)
    install(FILES ${built} DESTINATION ${folder}/overcast ${ARGN})
endfunction()
ovc_install_python(${OVC_PYTHON_DIR} COMPONENT local)
ovc_install_python(lib/python3/dist-packages COMPONENT debian EXCLUDE_FROM_ALL)
