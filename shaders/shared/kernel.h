// Makes a .comp file both a GLSL compute shader and the body of a C++ struct.
//
//   BUFFER(access, type, name)  on a line of its own, in a .comp file: storage buffer `name[]`; access: readonly,
//                               writeonly, restrict (both), coherent (atomics). The host writes the GLSL for it
//                               (compute/source.h): the macro language of GLSL cannot make the name of its block
//   KERNEL(count) { ... }                    the body; `invocation` runs over 0 .. count - 1
//   HAS(FEATURE)                             whether the scene requires it: a constant in GLSL, a value in C++
//   PREFETCH(element)                        of a buffer: it will be read soon; means something to processors only
//   PRIVATE(type, name)                      a variable of the invocation that functions share
#ifndef __cplusplus

#ifndef LOCAL_SIZE
#define LOCAL_SIZE 64
#endif
layout(local_size_x = LOCAL_SIZE) in;
layout(location = 0) uniform uint phase;

#define PRIVATE(type, name) type name;
#define PREFETCH(element)
#define HAS(feature) (feature)
#define PARAMETERS layout(std140, binding = 0) uniform ParameterBlock { Parameters params; };
#define KERNEL(count)                                                                            \
    void kernelBody(uint invocation);                                                            \
    void main() {                                                                                \
        uint row = gl_NumWorkGroups.x * uint(LOCAL_SIZE);                                        \
        uint invocation = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * row;               \
        if (invocation < (count)) kernelBody(invocation);                                        \
    }                                                                                            \
    void kernelBody(uint invocation)

#endif
