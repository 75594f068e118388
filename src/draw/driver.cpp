#include "draw/driver.h"

#include <array>
#include <string_view>
#include <vector>

#include <EGL/eglext.h>
#include <dlfcn.h>

namespace shaderx::draw {

namespace {

template <class Function>
bool find(void* library, const char* name, Function& function) {
    function = reinterpret_cast<Function>(::dlsym(library, name));
    return function != nullptr;
}

std::vector<EGLDeviceEXT> devicesOf(PFNEGLGETPROCADDRESSPROC getProcAddress) {
    const auto query = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(getProcAddress("eglQueryDevicesEXT"));
    EGLint count = 0;
    if (!query || !query(0, nullptr, &count) || count <= 0) return {};
    std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
    if (!query(count, devices.data(), &count) || count <= 0) return {};
    devices.resize(static_cast<std::size_t>(count));
    return devices;
}

// These come first: their displays need no window system, and Mesa's would draw on the CPU.
bool isNvidia(PFNEGLGETPROCADDRESSPROC getProcAddress, EGLDeviceEXT device) {
    const auto ask = reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(getProcAddress("eglQueryDeviceStringEXT"));
    const char* extensions = ask ? ask(device, EGL_EXTENSIONS) : nullptr;
    return extensions && std::string_view(extensions).find("EGL_NV_device_cuda") != std::string_view::npos;
}

// The displays worth trying: NVIDIA's devices, Mesa without a window system, other devices, whatever is the default.
std::vector<EGLDisplay> displays(void* egl, PFNEGLGETPROCADDRESSPROC getProcAddress) {
    std::vector<EGLDisplay> out;
    const auto platform = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(getProcAddress("eglGetPlatformDisplayEXT"));
    if (platform) {
        const std::vector<EGLDeviceEXT> devices = devicesOf(getProcAddress);
        const auto addDevices = [&](bool nvidia) {
            for (EGLDeviceEXT device : devices)
                if (isNvidia(getProcAddress, device) == nvidia)
                    out.push_back(platform(EGL_PLATFORM_DEVICE_EXT, device, nullptr));
        };
        addDevices(true);
        out.push_back(platform(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
        addDevices(false);
    }
    PFNEGLGETDISPLAYPROC getDisplay = nullptr;
    if (find(egl, "eglGetDisplay", getDisplay)) out.push_back(getDisplay(EGL_DEFAULT_DISPLAY));
    return out;
}

EGLContext createContext(void* egl, EGLDisplay display) {
    PFNEGLCHOOSECONFIGPROC chooseConfig = nullptr;
    PFNEGLCREATECONTEXTPROC create = nullptr;
    if (!find(egl, "eglChooseConfig", chooseConfig) || !find(egl, "eglCreateContext", create)) return EGL_NO_CONTEXT;
    const EGLint wanted[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!chooseConfig(display, wanted, &config, 1, &count) || count == 0) config = nullptr;
    static constexpr std::array<std::array<EGLint, 2>, 5> kVersions{{{4, 6}, {4, 5}, {4, 3}, {4, 1}, {3, 3}}};
    for (const auto& [major, minor] : kVersions) {
        const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                     major,
                                     EGL_CONTEXT_MINOR_VERSION,
                                     minor,
                                     EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                     EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                     EGL_NONE};
        if (EGLContext context = create(display, config, EGL_NO_CONTEXT, attributes)) return context;
    }
    return EGL_NO_CONTEXT;
}

}  // namespace

// The reason why there is no context, or an empty text.
std::string Driver::start() {
    void* egl = ::dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
    if (!egl) {
        const char* reason = ::dlerror();
        return reason ? reason : "libEGL.so.1 cannot be loaded";
    }
    PFNEGLINITIALIZEPROC initialize = nullptr;
    PFNEGLBINDAPIPROC bindApi = nullptr;
    if (!find(egl, "eglGetProcAddress", getProcAddress_) || !find(egl, "eglMakeCurrent", makeCurrent_) ||
        !find(egl, "eglDestroyContext", destroyContext_) || !find(egl, "eglInitialize", initialize) ||
        !find(egl, "eglBindAPI", bindApi))
        return "libEGL.so.1 lacks functions";
    for (EGLDisplay display : displays(egl, getProcAddress_)) {
        if (display == EGL_NO_DISPLAY || !initialize(display, nullptr, nullptr) || !bindApi(EGL_OPENGL_API)) continue;
        display_ = display;
        context_ = createContext(egl, display);
        if (context_ != EGL_NO_CONTEXT && makeCurrent()) break;
        if (context_ != EGL_NO_CONTEXT) destroyContext_(display_, context_);
        context_ = EGL_NO_CONTEXT;
    }
    if (context_ == EGL_NO_CONTEXT) return "no display gives an OpenGL 3.3 context";
#define SHADERX_GL_LOAD(ours, theirs, type)                                       \
    gl.ours = reinterpret_cast<PFNGL##type##PROC>(getProcAddress_("gl" #theirs)); \
    if (!gl.ours) return "the driver lacks gl" #theirs;
    SHADERX_GL_FUNCTIONS(SHADERX_GL_LOAD)
#undef SHADERX_GL_LOAD
    const GLubyte* name = gl.getString(GL_RENDERER);
    renderer = name ? reinterpret_cast<const char*>(name) : "";
    return {};
}

std::unique_ptr<Driver> Driver::open(Diagnostics& diagnostics) {
    std::unique_ptr<Driver> driver(new Driver);
    const std::string reason = driver->start();
    if (reason.empty()) return driver;
    diagnostics.error("no-driver", "there is no graphics driver to draw with: " + reason).hint =
        "install EGL and a driver, such as Mesa's (libegl1, libgl1-mesa-dri)";
    return nullptr;
}

Driver::~Driver() {
    if (context_ == EGL_NO_CONTEXT) return;
    makeCurrent_(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    destroyContext_(display_, context_);
}

bool Driver::makeCurrent() const {
    return makeCurrent_(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_TRUE;
}

}  // namespace shaderx::draw
