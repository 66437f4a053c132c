/* A headless OpenGL 3.3 core context on an EGL device: what a host has before it uses varikernel. C99 and C++. */
#ifndef HEADLESS_H
#define HEADLESS_H

#include <EGL/egl.h>
#include <EGL/eglext.h>

typedef struct headless {
    EGLDisplay display;
    EGLContext context;
} headless;

/* Makes the context current, or releases it; 1 if that worked. */
static inline int headless_make_current(const headless *host, int current) {
    return eglMakeCurrent(host->display, EGL_NO_SURFACE, EGL_NO_SURFACE,
                          current ? host->context : EGL_NO_CONTEXT) == EGL_TRUE;
}

/* Opens the first device that gives a context and makes it current; 1 if there is one. */
static inline int headless_open(headless *host) {
    static const EGLint config_wanted[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    static const EGLint context_wanted[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 3,
                                            EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                            EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    PFNEGLQUERYDEVICESEXTPROC query = (PFNEGLQUERYDEVICESEXTPROC)eglGetProcAddress("eglQueryDevicesEXT");
    PFNEGLGETPLATFORMDISPLAYEXTPROC get_display =
        (PFNEGLGETPLATFORMDISPLAYEXTPROC)eglGetProcAddress("eglGetPlatformDisplayEXT");
    EGLDeviceEXT devices[16];
    EGLint count = 0, i;
    host->display = EGL_NO_DISPLAY;
    host->context = EGL_NO_CONTEXT;
    if (!query || !get_display || !query(16, devices, &count)) {
        return 0;
    }
    for (i = 0; i < count; i++) {
        EGLConfig config;
        EGLint configs = 0;
        host->display = get_display(EGL_PLATFORM_DEVICE_EXT, devices[i], NULL);
        if (!eglInitialize(host->display, NULL, NULL)) {
            continue;
        }
        if (eglBindAPI(EGL_OPENGL_API) && eglChooseConfig(host->display, config_wanted, &config, 1, &configs) &&
            configs > 0) {
            host->context = eglCreateContext(host->display, config, EGL_NO_CONTEXT, context_wanted);
            if (host->context != EGL_NO_CONTEXT && headless_make_current(host, 1)) {
                return 1;
            }
        }
        eglTerminate(host->display);
    }
    return 0;
}

/* Destroys the context. */
static inline void headless_close(const headless *host) {
    headless_make_current(host, 0);
    eglDestroyContext(host->display, host->context);
    eglTerminate(host->display);
}

/* varikernel's loader; eglGetProcAddress gives a pointer to a function, which C keeps apart from data. */
static inline void *headless_loader(const char *name, void *user) {
    union {
        __eglMustCastToProperFunctionPointerType function;
        void *data;
    } address;
    (void)user;
    address.function = eglGetProcAddress(name);
    return address.data;
}

#endif
