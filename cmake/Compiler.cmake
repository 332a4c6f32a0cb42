# What every target of ours is built with. Contraction is off so that a kernel compiled as C++ gives the same bits as
# the same kernel compiled by Mesa's software renderer.
add_library(spherule_options INTERFACE)
target_compile_options(spherule_options INTERFACE
  -Wall -Wextra -Werror -Wpedantic -Wshadow -Wnon-virtual-dtor -Wdouble-promotion -ffp-contract=off)
target_compile_definitions(spherule_options INTERFACE SPHERULE_VERSION="${PROJECT_VERSION}")
if(SPHERULE_SANITIZE)
  add_compile_options(-fsanitize=${SPHERULE_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${SPHERULE_SANITIZE})
endif()
# For code that waits for users, networks or other code: it takes long to compile and little of the time of a run.
set(SPHERULE_LITTLE_OPTIMIZATION $<$<CONFIG:Release>:-O1>)
