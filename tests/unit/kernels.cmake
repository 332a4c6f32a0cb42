# A header with one struct per shaders/*.comp, named as the file: `spherule::kernels::cell_clear`.
file(GLOB kernel_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/shaders/*.comp)
set(kernel_structs)
set(kernel_names)
foreach(file ${kernel_files})
  get_filename_component(kernel ${file} NAME_WE)
  string(APPEND kernel_structs
    "struct ${kernel} : KernelBase {\n    using KernelBase::KernelBase;\n#include \"${kernel}.comp\"\n};\n\n")
  string(APPEND kernel_names "    {\"${kernel}\", &run<${kernel}>},\n")
endforeach()
file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/kernels/all_kernels.h CONTENT
"// Generated from the list of shaders/*.comp.
#pragma once

#include <string_view>

#include \"kernel_glue.h\"

namespace spherule::kernels {

@kernel_structs@struct Entry {
    std::string_view name;
    void (*run)(const Binding&);
};

constexpr Entry allKernels[] = {
@kernel_names@};

}  // namespace spherule::kernels
" @ONLY)

spherule_test(kernels_test LABEL unit
  SOURCES kernels_cells.cpp kernels_pairs.cpp kernels_scan.cpp kernels_support.cpp
  LIBRARIES glm::glm)
target_include_directories(kernels_test PRIVATE
  ${CMAKE_CURRENT_SOURCE_DIR} ${CMAKE_CURRENT_BINARY_DIR}/kernels ${PROJECT_SOURCE_DIR}/shaders)

add_test(NAME kernels_glsl
  COMMAND ${PYTHON3} ${CMAKE_CURRENT_SOURCE_DIR}/kernels_glsl.py ${PROJECT_SOURCE_DIR}/shaders ${GLSLANG})
set_tests_properties(kernels_glsl PROPERTIES LABELS unit TIMEOUT 300)
