// SPDX-License-Identifier: MIT
#include "EglWindow.h"

#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>

namespace test {

struct EglWindow::Egl {
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;
    EGLSurface surface = EGL_NO_SURFACE;
};

namespace {

template <typename Function>
Function function(const char* name) {
    return reinterpret_cast<Function>(eglGetProcAddress(name));
}

/// An initialised display, or EGL_NO_DISPLAY.
EGLDisplay openDisplay() {
    const auto platformDisplay =
        function<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
    if (!platformDisplay) return EGL_NO_DISPLAY;
    EGLDisplay display = platformDisplay(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
    if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr)) return display;
    const auto queryDevices = function<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
    EGLDeviceEXT device = nullptr;
    EGLint count = 0;
    if (!queryDevices || !queryDevices(1, &device, &count) || count < 1) return EGL_NO_DISPLAY;
    display = platformDisplay(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
    return display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) ? display
                                                                                 : EGL_NO_DISPLAY;
}

} // namespace

EglWindow::EglWindow(int width, int height, Profile profile) : _egl(std::make_unique<Egl>()) {
    _traits = new GraphicsContext::Traits;
    _traits->width = width;
    _traits->height = height;
    _traits->doubleBuffer = false;
    setState(new osg::State);
    getState()->setGraphicsContext(this);
    getState()->setContextID(osg::GraphicsContext::createNewContextID());
    getEventQueue()->syncWindowRectangleWithGraphicsContext();

    _egl->display = openDisplay();
    if (_egl->display == EGL_NO_DISPLAY || !eglBindAPI(EGL_OPENGL_API)) return;
    const EGLint wanted[] = {EGL_SURFACE_TYPE,
                             EGL_PBUFFER_BIT,
                             EGL_RENDERABLE_TYPE,
                             EGL_OPENGL_BIT,
                             EGL_RED_SIZE,
                             8,
                             EGL_GREEN_SIZE,
                             8,
                             EGL_BLUE_SIZE,
                             8,
                             EGL_DEPTH_SIZE,
                             24,
                             EGL_NONE};
    EGLConfig config = nullptr;
    EGLint found = 0;
    if (!eglChooseConfig(_egl->display, wanted, &config, 1, &found) || found < 1) return;
    const EGLint size[] = {EGL_WIDTH, width, EGL_HEIGHT, height, EGL_NONE};
    _egl->surface = eglCreatePbufferSurface(_egl->display, config, size);
    const EGLint core[] = {EGL_CONTEXT_MAJOR_VERSION,
                           4,
                           EGL_CONTEXT_MINOR_VERSION,
                           5,
                           EGL_CONTEXT_OPENGL_PROFILE_MASK,
                           EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                           EGL_NONE};
    _egl->context = eglCreateContext(_egl->display, config, EGL_NO_CONTEXT,
                                     profile == Profile::Core ? core : nullptr);
}

EglWindow::~EglWindow() {
    close(true);
    // Other code in this process may use the display.
    if (_egl->context != EGL_NO_CONTEXT) eglDestroyContext(_egl->display, _egl->context);
    if (_egl->surface != EGL_NO_SURFACE) eglDestroySurface(_egl->display, _egl->surface);
}

bool EglWindow::valid() const {
    return _egl->context != EGL_NO_CONTEXT && _egl->surface != EGL_NO_SURFACE;
}

bool EglWindow::realizeImplementation() {
    _isRealized = valid();
    return _isRealized;
}

void EglWindow::closeImplementation() {
    _isRealized = false;
}

bool EglWindow::makeCurrentImplementation() {
    eglBindAPI(EGL_OPENGL_API); // applies per thread
    return eglMakeCurrent(_egl->display, _egl->surface, _egl->surface, _egl->context) == EGL_TRUE;
}

bool EglWindow::releaseContextImplementation() {
    return eglMakeCurrent(_egl->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT) ==
           EGL_TRUE;
}

void EglWindow::swapBuffersImplementation() {
    eglSwapBuffers(_egl->display, _egl->surface);
}

} // namespace test
