# SPDX-License-Identifier: Apache-2.0
# cpack --config build/CPackConfig.cmake makes overcast_VERSION_ARCHITECTURE.deb, one package with
# everything. docs/guide/install.md.
set(debian ${PROJECT_BINARY_DIR}/debian)
set(maintainer "Overcast <overcast@example.org>")
if(DEFINED ENV{DEBEMAIL})
    set(maintainer "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")
endif()
set(OVC_MAINTAINER ${maintainer} CACHE STRING
    "Who answers for the Debian package; as DEBFULLNAME and DEBEMAIL say")

# Files that Debian's policy wants in a package besides those that cmake --install installs.
set(OVC_DEBIAN_VERSION ${PROJECT_VERSION}-1)
string(TIMESTAMP OVC_DEBIAN_DATE "%a, %d %b %Y %H:%M:%S +0000" UTC)
configure_file(cmake/debian/changelog.in ${debian}/changelog.Debian @ONLY)
configure_file(CHANGELOG.md ${debian}/changelog COPYONLY)
foreach(name changelog changelog.Debian)
    execute_process(COMMAND ${OVC_GZIP} -9nf ${debian}/${name} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
install(FILES ${debian}/changelog.gz ${debian}/changelog.Debian.gz cmake/debian/copyright
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/overcast COMPONENT debian EXCLUDE_FROM_ALL)
install(FILES cmake/debian/lintian-overrides RENAME overcast
    DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides COMPONENT debian EXCLUDE_FROM_ALL)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME overcast)
set(CPACK_PACKAGE_CONTACT ${OVC_MAINTAINER})
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_INSTALL_CMAKE_PROJECTS
    "${PROJECT_BINARY_DIR};overcast;overcast;/;${PROJECT_BINARY_DIR};overcast;debian;/")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "ray tracing of scenes larger than the memory of the GPU")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"Overcast finds where rays hit triangles: a library that a renderer loads, with
a fixed budget of GPU memory and answers proven right, through OpenGL on a GPU
or on Mesa's software renderer.

This package has the library libovercast.so with its header, the command
overcast, which renders .ply, .obj, .pbrt and .pov scenes, and the Python
module overcast.")
if(TARGET overcast_tachyon)
    string(APPEND CPACK_DEBIAN_PACKAGE_DESCRIPTION
        " overcast-tachyon runs tachyon with the library\nin it.")
endif()
# dpkg-shlibdeps finds the libraries that are linked. EGL and OpenGL are loaded at run time, so we
# name them here; they need a driver, which is only recommended.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libegl1, libopengl0 | libgl1")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libegl-mesa0, libgl1-mesa-dri, python3, python3-numpy")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS
    "pkg-config, cmake, tachyon, povray, python3-matplotlib, python3-jinja2")
# symbols and shlibs say which package programs that link the library depend on; the triggers update
# the linker's cache.
configure_file(cmake/debian/symbols.in ${debian}/symbols @ONLY)
configure_file(cmake/debian/shlibs.in ${debian}/shlibs @ONLY)
set(OVC_CONTROL_FILES postinst prerm triggers)
list(TRANSFORM OVC_CONTROL_FILES PREPEND ${PROJECT_SOURCE_DIR}/cmake/debian/)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA "${OVC_CONTROL_FILES};${debian}/symbols;${debian}/shlibs")
include(CPack)
