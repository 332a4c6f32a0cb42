# cmake -D NPM=... -D PROTOC=... -D OUT=... -P build.cmake, in web-viewer/
# Bundles the page into OUT.
include(${CMAKE_CURRENT_LIST_DIR}/install.cmake)
execute_process(COMMAND ${NPM} run --silent build -- --out ${OUT} --protoc ${PROTOC} COMMAND_ERROR_IS_FATAL ANY)
