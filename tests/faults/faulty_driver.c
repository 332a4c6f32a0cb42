// An EGL vendor library for tests. It passes all calls to Mesa until the file that SPHERULE_FAULT_WHEN names exists.
// Then it fails in the way that SPHERULE_FAULT names:
// - reset: the device reports one reset; destroying an object then blocks for ever;
// - hang: the device stops computing, and calls that wait for it block for ever;
// - memory: buffers of 1 MiB or more cannot be allocated;
// - buffers: a kernel may have at most 8 storage buffers.
//
// Libglvnd loads the library through a vendor file, which tests/support/py/faults.py writes.
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum {
    MIB = 1 << 20,
    GUILTY_CONTEXT_RESET = 0x8253,
    TIMEOUT_EXPIRED = 0x911B,
    OUT_OF_MEMORY = 0x0505,
    MAX_COMPUTE_SHADER_STORAGE_BLOCKS = 0x90DB
};

typedef void (*Function)(void);
typedef Function (*GetProcAddress)(const char*);

// The beginning of libglvnd's __EGLapiImports (glvnd/libeglabi.h), which stays the same in later versions.
typedef struct {
    Function others[3];
    GetProcAddress getProcAddress;
} Imports;
typedef unsigned (*Main)(unsigned version, const void* exports, void* vendor, Imports* imports);

static GetProcAddress mesa;

static int failsBy(const char* fault) {
    const char* const wanted = getenv("SPHERULE_FAULT");
    const char* const when = getenv("SPHERULE_FAULT_WHEN");
    return wanted != NULL && when != NULL && strcmp(wanted, fault) == 0 && access(when, F_OK) == 0;
}

static void hang(void) {
    for (;;) pause();
}

static unsigned resetStatus(void) {
    static int said;
    return failsBy("reset") && !said++ ? GUILTY_CONTEXT_RESET : 0;
}

static unsigned clientWaitSync(void* fence, unsigned flags, unsigned long long nanoseconds) {
    if (failsBy("hang")) {
        usleep((unsigned)(nanoseconds / 1000));
        return TIMEOUT_EXPIRED;
    }
    return ((unsigned (*)(void*, unsigned, unsigned long long))mesa("glClientWaitSync"))(fence, flags, nanoseconds);
}

static void finish(void) {
    if (failsBy("hang")) hang();
    mesa("glFinish")();
}

static void deleteBuffers(int count, const unsigned* names) {
    if (failsBy("hang") || failsBy("reset")) hang();
    ((void (*)(int, const unsigned*))mesa("glDeleteBuffers"))(count, names);
}

static void deleteProgram(unsigned name) {
    if (failsBy("hang") || failsBy("reset")) hang();
    ((void (*)(unsigned))mesa("glDeleteProgram"))(name);
}

static int refused;

static void namedBufferStorage(unsigned name, long size, const void* data, unsigned flags) {
    if (failsBy("memory") && size >= MIB) {
        refused = 1;
        return;
    }
    ((void (*)(unsigned, long, const void*, unsigned))mesa("glNamedBufferStorage"))(name, size, data, flags);
}

static unsigned getError(void) {
    if (refused) {
        refused = 0;
        return OUT_OF_MEMORY;
    }
    return ((unsigned (*)(void))mesa("glGetError"))();
}

static void getIntegerv(unsigned name, int* value) {
    ((void (*)(unsigned, int*))mesa("glGetIntegerv"))(name, value);
    if (failsBy("buffers") && name == MAX_COMPUTE_SHADER_STORAGE_BLOCKS) *value = 8;
}

static const struct {
    const char* name;
    Function function;
} ours[] = {
    {"glGetGraphicsResetStatus", (Function)resetStatus},
    {"glClientWaitSync", (Function)clientWaitSync},
    {"glFinish", (Function)finish},
    {"glDeleteBuffers", (Function)deleteBuffers},
    {"glDeleteProgram", (Function)deleteProgram},
    {"glNamedBufferStorage", (Function)namedBufferStorage},
    {"glGetError", (Function)getError},
    {"glGetIntegerv", (Function)getIntegerv},
};

static Function getProcAddress(const char* name) {
    for (unsigned k = 0; k < sizeof ours / sizeof ours[0]; ++k)
        if (strcmp(name, ours[k].name) == 0) return ours[k].function;
    return mesa(name);
}

// The function that libglvnd calls after loading this library.
unsigned __egl_Main(unsigned version, const void* exports, void* vendor, Imports* imports);
unsigned __egl_Main(unsigned version, const void* exports, void* vendor, Imports* imports) {
    void* const library = dlopen("libEGL_mesa.so.0", RTLD_NOW | RTLD_LOCAL);
    const Main main = library == NULL ? NULL : (Main)dlsym(library, "__egl_Main");
    if (main == NULL || !main(version, exports, vendor, imports)) {
        fprintf(stderr, "the faulty driver needs Mesa's: %s\n", dlerror());
        return 0;
    }
    mesa = imports->getProcAddress;
    imports->getProcAddress = getProcAddress;
    return 1;
}
