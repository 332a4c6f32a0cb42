# Adds the program spherule_stepper to a checkout of an older commit, which may not have it:
#
#   cmake -D CMAKE_PROJECT_spherule_INCLUDE=THIS_FILE
#
# It is added at the end of the older CMakeLists.txt, because all libraries are known there.
function(spherule_add_stepper)
  add_executable(spherule_stepper ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/stepper.cpp)
  target_link_libraries(spherule_stepper PRIVATE spherule_sim spherule_options)
  set_target_properties(spherule_stepper PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})
endfunction()
cmake_language(DEFER CALL spherule_add_stepper)
