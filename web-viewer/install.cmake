# cmake -D NPM=... -P install.cmake, in a folder with package-lock.json
# Installs the packages of the lock file, if they are not installed yet. Build trees share the folder, so it is locked.
function(install_packages)
  if(EXISTS node_modules/.package-lock.json AND NOT package-lock.json IS_NEWER_THAN node_modules/.package-lock.json)
    return()
  endif()
  execute_process(COMMAND ${NPM} ci --no-audit --no-fund --loglevel=error COMMAND_ERROR_IS_FATAL ANY)
  file(TOUCH node_modules/.package-lock.json)
endfunction()
file(LOCK ${CMAKE_CURRENT_BINARY_DIR}/.install.lock TIMEOUT 600)
install_packages()
