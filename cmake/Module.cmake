# The headers of libraries that most modules include, compiled once.
file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/headers.cpp CONTENT "")
add_library(spherule_headers OBJECT ${CMAKE_BINARY_DIR}/headers.cpp)
target_link_libraries(spherule_headers
  PRIVATE spherule_options tl::expected spdlog::spdlog glm::glm protobuf::libprotobuf)
target_precompile_headers(spherule_headers PRIVATE
  <algorithm> <array> <bit> <charconv> <chrono> <cmath> <cstdint> <filesystem> <functional> <limits> <map> <memory>
  <numeric> <optional> <span> <string> <string_view> <variant> <vector>
  <fmt/format.h> <glm/glm.hpp> <google/protobuf/map.h> <google/protobuf/message.h> <google/protobuf/repeated_field.h>
  <spdlog/spdlog.h> <tl/expected.hpp>)

# spherule_module(NAME [HEADERS_OF target] SOURCES ... USES other modules ... LIBRARIES ...)
# One static library per folder of server/. Its headers are seen as "NAME/..." only by targets that use it, so the
# compiler refuses an include that the architecture does not allow. HEADERS_OF names a target with other precompiled
# headers.
function(spherule_module name)
  cmake_parse_arguments(ARG "" "HEADERS_OF" "SOURCES;USES;LIBRARIES" ${ARGN})
  set(root ${CMAKE_BINARY_DIR}/include/${name})
  file(MAKE_DIRECTORY ${root})
  file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR} ${root}/${name} SYMBOLIC)
  add_library(spherule_${name} STATIC ${ARG_SOURCES})
  target_include_directories(spherule_${name} PUBLIC ${root})
  target_link_libraries(spherule_${name} PRIVATE spherule_options)
  if(NOT ARG_HEADERS_OF)
    set(ARG_HEADERS_OF spherule_headers)
  endif()
  target_precompile_headers(spherule_${name} REUSE_FROM ${ARG_HEADERS_OF})
  foreach(used ${ARG_USES})
    target_link_libraries(spherule_${name} PUBLIC spherule_${used})
  endforeach()
  target_link_libraries(spherule_${name} PUBLIC ${ARG_LIBRARIES})
endfunction()
