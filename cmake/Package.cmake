# `cmake --install` and `cpack -G DEB`: the program as a service of Debian 12. deploy/package.sh makes the package.
set(package ${PROJECT_SOURCE_DIR}/deploy/package)
set(documents ${PROJECT_BINARY_DIR}/documents)

set(CPACK_PACKAGE_NAME spherule)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "The Spherule authors <maintainers@spherule.example.org>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "server that simulates spheres and shows them in browsers")
set(CPACK_PACKAGE_DESCRIPTION
"Spherule steps a scene of many thousands of spheres, on a GPU with OpenGL
compute shaders or on all processors, and needs no display. It streams the
scene to browsers over WebSockets. Several viewers watch one world and steer
it. The package contains the program, the page, the scenes and a service.")
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# One of them has systemd-sysusers, which makes the user.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "systemd | systemd-standalone-sysusers | systemd-sysusers")
# The program opens EGL's loader if there is one. Without it, only the processors compute.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS libegl1)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "libgl1-mesa-dri, nginx")
file(WRITE ${PROJECT_BINARY_DIR}/conffiles "/etc/spherule/serve.toml\n")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA
  ${package}/postinst ${package}/prerm ${package}/postrm ${PROJECT_BINARY_DIR}/conffiles)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

install(TARGETS spherule RUNTIME DESTINATION bin)
install(FILES deploy/systemd/spherule.service DESTINATION /lib/systemd/system)
install(FILES deploy/systemd/sysusers.conf DESTINATION lib/sysusers.d RENAME spherule.conf)
install(FILES deploy/systemd/serve.toml DESTINATION /etc/spherule)
install(FILES README.md DESTINATION share/doc/spherule)
install(DIRECTORY docs/ DESTINATION share/doc/spherule/docs FILES_MATCHING PATTERN "*.md" PATTERN images EXCLUDE)
install(DIRECTORY deploy/nginx deploy/monitoring DESTINATION share/doc/spherule/examples)
# Manual pages and others are made by the program that is installed, so they cannot be out of date.
install(CODE "
  file(REMOVE_RECURSE \"${documents}\")
  execute_process(
    COMMAND \"${PYTHON3}\" -B \"${package}/documents.py\" \"$<TARGET_FILE:spherule>\" ${PROJECT_VERSION}
      ${CPACK_DEBIAN_PACKAGE_RELEASE} \"${CPACK_PACKAGE_CONTACT}\" \"${documents}\"
    COMMAND_ERROR_IS_FATAL ANY)")
install(DIRECTORY ${documents}/ DESTINATION share)

include(CPack)
