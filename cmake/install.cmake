# SPDX-License-Identifier: Apache-2.0
# cmake --install: the library, its headers, CMake package, pkg-config file and Python module; the
# command is in install_command.cmake. All find each other by the way from one to the next, so that
# an installed tree may be moved. docs/guide/install.md.
#
# The component `overcast` goes to the same places everywhere. `local` has the files that an
# installation by hand puts elsewhere than a Debian package does; `debian` has the package's
# versions of those and the files that only a package has (cmake/package.cmake).
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/Overcast)

install(TARGETS overcast_plugin EXPORT Overcast
    LIBRARY COMPONENT overcast NAMELINK_COMPONENT overcast
    INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES plugin/overcast.h plugin/overcast.hpp plugin/overcast_ranks.h
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/overcast COMPONENT overcast)

install(FILES plugin/examples/hills.c plugin/examples/ranks.c plugin/examples/sunlit.cpp
    DESTINATION ${CMAKE_INSTALL_DOCDIR}/examples COMPONENT overcast)

# find_package(Overcast): the target Overcast::overcast
set_target_properties(overcast_plugin PROPERTIES EXPORT_NAME overcast)
install(EXPORT Overcast NAMESPACE Overcast:: FILE OvercastTargets.cmake
    DESTINATION ${package_dir} COMPONENT overcast)
configure_package_config_file(
    cmake/OvercastConfig.cmake.in ${PROJECT_BINARY_DIR}/OvercastConfig.cmake
    INSTALL_DESTINATION ${package_dir} PATH_VARS CMAKE_INSTALL_LIBDIR
    NO_SET_AND_CHECK_MACRO)
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
# Not in the cache, so that a Python that is installed later is asked.
if(NOT OVC_PYTHON_DIR)
    set(OVC_PYTHON_DIR lib/python3/dist-packages)
    message(STATUS "No Python (Debian: python3) tells where it looks for modules: ours is "
        "installed into ${OVC_PYTHON_DIR} below the prefix")
endif()
ovc_install_python(${OVC_PYTHON_DIR} COMPONENT local)
ovc_install_python(lib/python3/dist-packages COMPONENT debian EXCLUDE_FROM_ALL)
