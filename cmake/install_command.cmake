# SPDX-License-Identifier: Apache-2.0
# cmake --install: the command, its manual and completions, and what it loads besides the library.
install(TARGETS overcast RUNTIME COMPONENT overcast)
# Only the command loads it, so it lies in a folder of its own.
install(TARGETS overcast_thesis
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/overcast COMPONENT overcast)
# The same ABI for scenes of several processes, where there is MPI. Only an installation by hand has
# it: a package would ask for MPI wherever Overcast is wanted.
if(TARGET overcast_mpi)
    install(TARGETS overcast_mpi
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/overcast COMPONENT local)
endif()
# The reader of pictures, where there is OpenImageIO. Only an installation by hand has it, since a
# package would ask for its hundred packages.
if(TARGET overcast_textures)
    install(TARGETS overcast_textures
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/overcast COMPONENT local)
endif()
# tachyon with Overcast in it, where it is built. Only overcast-tachyon preloads the module.
if(TARGET overcast_tachyon)
    install(TARGETS overcast-tachyon RUNTIME COMPONENT overcast)
    install(TARGETS overcast_tachyon
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/overcast COMPONENT overcast)
endif()

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
