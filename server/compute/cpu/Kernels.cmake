# Checks the kernels of shaders/ and generates two headers from their text: compute/cpu/all_kernels.h, with one struct per
# .comp file and a table of them, and compute/cpu/lane_kernels.h, the same for the kernels with lanes.
#
# In script mode, `cmake -D SPHERULE_SHADERS=FOLDER -P Kernels.cmake` only checks the kernels of FOLDER.
set(most_buffers 16)  # maxKernelBuffers of compute/device.h
if(CMAKE_SCRIPT_MODE_FILE)
  cmake_minimum_required(VERSION 3.25)
  set(shader_folder ${SPHERULE_SHADERS})
  file(GLOB kernel_files ${shader_folder}/*.comp)
  file(GLOB shared_files ${shader_folder}/shared/*.h ${shader_folder}/shapes/*.h)
else()
  set(shader_folder ${PROJECT_SOURCE_DIR}/shaders)
  file(GLOB kernel_files CONFIGURE_DEPENDS ${shader_folder}/*.comp)
  file(GLOB shared_files CONFIGURE_DEPENDS ${shader_folder}/shared/*.h ${shader_folder}/shapes/*.h)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS
    ${kernel_files} ${shared_files} ${shader_folder}/features.def ${shader_folder}/shapes.def)
endif()
list(REMOVE_ITEM shared_files ${shader_folder}/shared/kernel.h)

file(STRINGS ${shader_folder}/features.def features REGEX "^FEATURE\\(")
file(STRINGS ${shader_folder}/shapes.def shapes REGEX "^SHAPE\\(")
list(APPEND features ${shapes})
list(TRANSFORM features REPLACE "^[A-Z]+\\(([A-Z_]+),.*" "\\1")
list(LENGTH features count)
if(count GREATER 64)
  message(FATAL_ERROR "shaders/features.def defines ${count} features; the bits of a launch hold 64")
endif()

set(structs)
set(entries)
set(lane_structs)
set(lane_entries)
foreach(file ${kernel_files} ${shared_files})
  file(READ ${file} text)
  file(RELATIVE_PATH path ${shader_folder}/.. ${file})
  string(REGEX MATCHALL "HAS\\([A-Z_]+\\)" uses "${text}")
  foreach(use ${uses})
    string(REGEX REPLACE "HAS\\((.*)\\)" "\\1" feature ${use})
    if(NOT feature IN_LIST features)
      message(FATAL_ERROR "${path} asks ${use}, but shaders/features.def defines no feature ${feature}")
    endif()
  endforeach()
  string(REGEX MATCHALL "\nBUFFER\\([^)]*\\)" buffers "${text}")
  list(LENGTH buffers count)
  if(NOT file MATCHES "\\.comp$")
    if(count GREATER 0)
      message(FATAL_ERROR "${path} declares a buffer; only .comp files do")
    endif()
    continue()
  endif()
  if(count GREATER most_buffers)
    message(FATAL_ERROR "${path} declares ${count} buffers; a kernel has at most ${most_buffers}")
  endif()
  get_filename_component(kernel ${file} NAME_WE)
  set(declared)
  foreach(buffer ${buffers})
    if(NOT buffer MATCHES "BUFFER\\((readonly|writeonly|restrict|coherent), ([A-Za-z0-9]+), ([A-Za-z0-9]+)\\)")
      string(STRIP "${buffer}" buffer)
      message(FATAL_ERROR "${path}: ${buffer} is not of the form BUFFER(access, type, name)")
    endif()
    string(APPEND declared "{\"${CMAKE_MATCH_2}\", \"${CMAKE_MATCH_3}\"}, ")
  endforeach()
  string(FIND "${text}" "\nPARAMETERS" at)
  set(parameters true)
  if(at EQUAL -1)
    set(parameters false)
  endif()
  # How many invocations a thread takes at least: a bundle of pairs is much work, and lanes fill whole vectors.
  set(smallest_range 4)
  if(text MATCHES "\nLANE_KERNEL")
    set(smallest_range 16)
  elseif(text MATCHES "\n(LANE_)?PAIR_KERNEL|\nBUNDLE_KERNEL|\nKERNEL\\(bundlesOfPhase")
    set(smallest_range 1)
  endif()
  string(CONCAT struct
    "struct ${kernel} : KernelBase {\n    using KernelBase::KernelBase;\n"
    "    static constexpr BufferDeclaration declared[] = {${declared}};\n#include \"${kernel}.comp\"\n};\n\n")
  set(entry "    {\"${kernel}.comp\", ${kernel}::declared, ${parameters}, &countOf<${kernel}>, ${smallest_range}, \
&run<${kernel}>},\n")
  string(APPEND structs "${struct}")
  string(APPEND entries "${entry}")
  if(text MATCHES "\nLANE_")
    string(APPEND lane_structs "${struct}")
    string(APPEND lane_entries "${entry}")
  endif()
endforeach()
if(CMAKE_SCRIPT_MODE_FILE)
  return()
endif()

set(generated ${CMAKE_CURRENT_BINARY_DIR}/generated)
function(write_table file structs entries)
  file(CONFIGURE OUTPUT ${generated}/compute/cpu/${file} CONTENT
"// Generated from the list of shaders/*.comp.
namespace spherule::compute::cpu::SPHERULE_PRECISION {

@structs@constexpr Entry all[] = {
@entries@};

}  // namespace spherule::compute::cpu::SPHERULE_PRECISION
" @ONLY)
endfunction()
write_table(all_kernels.h "${structs}" "${entries}")
write_table(lane_kernels.h "${lane_structs}" "${lane_entries}")
