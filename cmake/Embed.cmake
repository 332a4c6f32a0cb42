# spherule_embed(TARGET FUNCTION FILES ... BASE dir DEPENDS ...)
# A static library with the bytes of FILES; "embedded/FUNCTION.h" declares
# `std::span<const spherule::embedded::File> FUNCTION()`, each with its path relative to BASE.
set(SPHERULE_EMBED_SCRIPT ${CMAKE_CURRENT_LIST_DIR}/embed.py)
find_program(PYTHON3 python3 REQUIRED)
function(spherule_embed target function)
  cmake_parse_arguments(ARG "" "BASE" "FILES;DEPENDS" ${ARGN})
  set(out ${CMAKE_CURRENT_BINARY_DIR}/embed_${function})
  add_custom_command(
    OUTPUT ${out}/${function}.cpp ${out}/embedded/${function}.h
    COMMAND ${PYTHON3} ${SPHERULE_EMBED_SCRIPT} ${out} ${function} ${ARG_BASE} ${ARG_FILES}
    DEPENDS ${SPHERULE_EMBED_SCRIPT} ${ARG_FILES} ${ARG_DEPENDS}
    VERBATIM)
  add_library(${target} STATIC ${out}/${function}.cpp)
  target_include_directories(${target} PUBLIC ${out})
endfunction()
