# Loaders for EGL and OpenGL, generated at build time. They open the libraries at run time, so that the
# program starts on a host without them and reports the missing library.
set(glad_out ${CMAKE_CURRENT_BINARY_DIR}/glad)
set(glad_extensions
  EGL_EXT_client_extensions EGL_EXT_create_context_robustness EGL_EXT_device_base EGL_EXT_device_drm
  EGL_EXT_device_enumeration EGL_EXT_device_query EGL_EXT_device_query_name EGL_EXT_platform_base
  EGL_EXT_platform_device EGL_KHR_debug EGL_KHR_no_config_context EGL_KHR_surfaceless_context
  EGL_MESA_platform_surfaceless EGL_NV_device_cuda GL_KHR_debug GL_KHR_robustness)
list(JOIN glad_extensions "," glad_extension_list)
add_custom_command(
  OUTPUT ${glad_out}/src/egl.c ${glad_out}/src/gl.c ${glad_out}/include/glad/egl.h ${glad_out}/include/glad/gl.h
  COMMAND ${GLAD} --api gl:core=4.5,egl=1.5 --extensions ${glad_extension_list} --reproducible --quiet
          --out-path ${glad_out} c --loader
  DEPENDS ${CMAKE_CURRENT_LIST_FILE}
  COMMENT "generating the EGL and OpenGL loaders"
  VERBATIM)
add_library(spherule_glad STATIC ${glad_out}/src/egl.c ${glad_out}/src/gl.c)
file(MAKE_DIRECTORY ${glad_out}/include)
target_include_directories(spherule_glad SYSTEM PUBLIC ${glad_out}/include)
target_link_libraries(spherule_glad PUBLIC ${CMAKE_DL_LIBS})
