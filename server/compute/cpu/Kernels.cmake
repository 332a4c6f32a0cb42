# Generates, from the text of shaders/: compute/cpu/all_kernels.h, one struct per .comp file and a table of them, and
# compute/cpu/features.h, one bit for each feature that any of them asks for.
file(GLOB kernel_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/shaders/*.comp)
file(GLOB shared_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/shaders/shared/*.h)
list(REMOVE_ITEM shared_files ${PROJECT_SOURCE_DIR}/shaders/shared/kernel.h)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${kernel_files} ${shared_files})
set(structs)
set(entries)
set(features)
foreach(file ${kernel_files} ${shared_files})
  file(READ ${file} text)
  string(REGEX MATCHALL "HAS\\([A-Z_]+\\)" uses "${text}")
  list(APPEND features ${uses})
  get_filename_component(kernel ${file} NAME_WE)
  if(NOT file MATCHES "\\.comp$")
    continue()
  endif()
  set(slots 0)
  string(REGEX MATCHALL "BUFFER\\([0-9]+" buffers "${text}")
  foreach(buffer ${buffers})
    string(REGEX REPLACE "[^0-9]" "" number ${buffer})
    math(EXPR next "${number} + 1")
    if(next GREATER slots)
      set(slots ${next})
    endif()
  endforeach()
  string(FIND "${text}" "\nPARAMETERS" at)
  set(parameters true)
  if(at EQUAL -1)
    set(parameters false)
  endif()
  string(APPEND structs
    "struct ${kernel} : KernelBase {\n    using KernelBase::KernelBase;\n#include \"${kernel}.comp\"\n};\n\n")
  string(APPEND entries
    "    {\"${kernel}.comp\", ${slots}, ${parameters}, &countOf<${kernel}>, &run<${kernel}>},\n")
endforeach()
list(REMOVE_DUPLICATES features)
list(SORT features)
set(bits)
set(names)
set(bit 0)
foreach(feature ${features})
  string(REGEX REPLACE "HAS\\((.*)\\)" "\\1" feature ${feature})
  string(APPEND bits "        ${feature} = 1U << ${bit}U,\n")
  string(APPEND names "    \"${feature}\",\n")
  math(EXPR bit "${bit} + 1")
endforeach()

set(generated ${CMAKE_CURRENT_BINARY_DIR}/generated)
file(CONFIGURE OUTPUT ${generated}/compute/cpu/features.h CONTENT
"// Generated from the uses of HAS in shaders/.
#pragma once

#include <cstdint>
#include <string_view>

namespace spherule::compute::cpu {

struct Features {
    enum Bit : std::uint32_t {
@bits@    };
};

// By bit.
constexpr std::string_view featureNames[] = {
@names@};

}  // namespace spherule::compute::cpu
" @ONLY)
file(CONFIGURE OUTPUT ${generated}/compute/cpu/all_kernels.h CONTENT
"// Generated from the list of shaders/*.comp.
namespace spherule::compute::cpu::SPHERULE_PRECISION {

@structs@constexpr Entry all[] = {
@entries@};

}  // namespace spherule::compute::cpu::SPHERULE_PRECISION
" @ONLY)
