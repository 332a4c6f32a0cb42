/* The EGL library of a vendor whose driver lists one device, and refuses to open it. EGL's dispatch library (libglvnd)
   loads it by a vendor file and calls __egl_Main. The structs are a part of the interface of libglvnd. */
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <glad/egl.h>

struct imports {
    EGLDisplay (*getPlatformDisplay)(EGLenum platform, void* native, const EGLAttrib* attributes);
    EGLBoolean (*getSupportsAPI)(EGLenum api);
    const char* (*getVendorString)(int name);
    void* (*getProcAddress)(const char* name);
    void* (*getDispatchAddress)(const char* name);
    void (*setDispatchIndex)(const char* name, int index);
};

static int device;
static EGLint error = EGL_SUCCESS;

static EGLDisplay displayOf(EGLenum platform, void* native, const EGLAttrib* attributes) {
    (void)platform, (void)native, (void)attributes;
    return &device;
}

static EGLBoolean refuse(EGLDisplay display, EGLint* major, EGLint* minor) {
    (void)display, (void)major, (void)minor;
    error = EGL_BAD_ACCESS;
    return EGL_FALSE;
}

static EGLBoolean supportsApi(EGLenum api) {
    return api == EGL_OPENGL_API;
}

static const char* vendorString(int name) {
    return name == 0 ? "EGL_EXT_platform_device EGL_EXT_platform_base" : NULL; /* platform extensions */
}

static void* nothing(void) {
    return NULL;
}

static EGLint takeError(void) {
    const EGLint last = error;
    error = EGL_SUCCESS;
    return last;
}

static const char* queryString(EGLDisplay display, EGLint name) {
    (void)display;
    return name == EGL_EXTENSIONS ? "EGL_EXT_client_extensions EGL_EXT_device_base EGL_EXT_device_enumeration "
                                    "EGL_EXT_device_query EGL_EXT_platform_base EGL_EXT_platform_device"
                                  : NULL;
}

static EGLBoolean queryDevices(EGLint most, EGLDeviceEXT* devices, EGLint* count) {
    if (devices != NULL && most > 0) devices[0] = &device;
    *count = 1;
    return EGL_TRUE;
}

static const char* queryDeviceString(EGLDeviceEXT which, EGLint name) {
    (void)which;
    return name == EGL_EXTENSIONS ? "EGL_NV_device_cuda" : NULL;
}

static EGLBoolean queryDeviceAttribute(EGLDeviceEXT which, EGLint attribute, EGLAttrib* value) {
    (void)which;
    if (attribute != EGL_CUDA_DEVICE_NV) return EGL_FALSE;
    *value = 3;
    return EGL_TRUE;
}

static void* function(const char* name) {
    if (strcmp(name, "eglInitialize") == 0) return (void*)refuse;
    if (strcmp(name, "eglGetError") == 0) return (void*)takeError;
    if (strcmp(name, "eglQueryString") == 0) return (void*)queryString;
    if (strcmp(name, "eglQueryDevicesEXT") == 0) return (void*)queryDevices;
    if (strcmp(name, "eglQueryDeviceStringEXT") == 0) return (void*)queryDeviceString;
    if (strcmp(name, "eglQueryDeviceAttribEXT") == 0) return (void*)queryDeviceAttribute;
    return (void*)nothing;
}

/* The functions that libglvnd does not know: it calls them for the devices of all vendors. */
static void* dispatched(const char* name) {
    return strncmp(name, "eglQueryDevice", 14) == 0 ? function(name) : NULL;
}

static void ignoreIndex(const char* name, int index) {
    (void)name, (void)index;
}

__attribute__((visibility("default"))) EGLBoolean __egl_Main(uint32_t version, const void* exports, void* vendor,
                                                             struct imports* imports) {
    (void)version, (void)exports, (void)vendor;
    imports->getPlatformDisplay = displayOf;
    imports->getSupportsAPI = supportsApi;
    imports->getVendorString = vendorString;
    imports->getProcAddress = function;
    imports->getDispatchAddress = dispatched;
    imports->setDispatchIndex = ignoreIndex;
    return EGL_TRUE;
}
