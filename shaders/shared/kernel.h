// Makes a .comp file both a GLSL compute shader and the body of a C++ struct.
//
//   BUFFER(access, type, name)  Declares the storage buffer `name[]`, on a line of its own, in a .comp file. Access is
//                               readonly, writeonly, restrict (both) or coherent (atomics). The host writes its GLSL
//                               (compute/source.h), because the macro language of GLSL cannot form the block's name.
//   KERNEL(count) { ... }       Defines the body; `invocation` runs over 0 .. count - 1.
//   HAS(FEATURE)                Is true if the scene requires the feature: a constant in GLSL, a value in C++.
//   PREFETCH(element)           Announces that an element of a buffer is read soon. It has an effect on CPUs only.
//   PRIVATE(type, name)         Declares a variable of the invocation that functions share.
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
