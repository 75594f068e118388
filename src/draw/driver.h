// The graphics driver, loaded at run time: EGL without a display, and OpenGL 3.3 or later through it.
#pragma once

#define EGL_NO_X11
#include <memory>
#include <string>

#include <EGL/egl.h>
#include <GL/glcorearb.h>

#include "base/diagnostics.h"

namespace shaderx::draw {

// Our name, the driver's name, the type's name.
#define SHADERX_GL_FUNCTIONS(X)                                                        \
    X(activeTexture, ActiveTexture, ACTIVETEXTURE)                                     \
    X(attachShader, AttachShader, ATTACHSHADER)                                        \
    X(beginQuery, BeginQuery, BEGINQUERY)                                              \
    X(bindBuffer, BindBuffer, BINDBUFFER)                                              \
    X(bindBufferBase, BindBufferBase, BINDBUFFERBASE)                                  \
    X(bindFramebuffer, BindFramebuffer, BINDFRAMEBUFFER)                               \
    X(bindRenderbuffer, BindRenderbuffer, BINDRENDERBUFFER)                            \
    X(bindSampler, BindSampler, BINDSAMPLER)                                           \
    X(bindTexture, BindTexture, BINDTEXTURE)                                           \
    X(bindVertexArray, BindVertexArray, BINDVERTEXARRAY)                               \
    X(bufferData, BufferData, BUFFERDATA)                                              \
    X(checkFramebufferStatus, CheckFramebufferStatus, CHECKFRAMEBUFFERSTATUS)          \
    X(clear, Clear, CLEAR)                                                             \
    X(clearColor, ClearColor, CLEARCOLOR)                                              \
    X(compileShader, CompileShader, COMPILESHADER)                                     \
    X(createProgram, CreateProgram, CREATEPROGRAM)                                     \
    X(createShader, CreateShader, CREATESHADER)                                        \
    X(deleteBuffers, DeleteBuffers, DELETEBUFFERS)                                     \
    X(deleteFramebuffers, DeleteFramebuffers, DELETEFRAMEBUFFERS)                      \
    X(deleteProgram, DeleteProgram, DELETEPROGRAM)                                     \
    X(deleteQueries, DeleteQueries, DELETEQUERIES)                                     \
    X(deleteRenderbuffers, DeleteRenderbuffers, DELETERENDERBUFFERS)                   \
    X(deleteSamplers, DeleteSamplers, DELETESAMPLERS)                                  \
    X(deleteShader, DeleteShader, DELETESHADER)                                        \
    X(deleteTextures, DeleteTextures, DELETETEXTURES)                                  \
    X(deleteVertexArrays, DeleteVertexArrays, DELETEVERTEXARRAYS)                      \
    X(drawElements, DrawElements, DRAWELEMENTS)                                        \
    X(enable, Enable, ENABLE)                                                          \
    X(enableVertexAttribArray, EnableVertexAttribArray, ENABLEVERTEXATTRIBARRAY)       \
    X(endQuery, EndQuery, ENDQUERY)                                                    \
    X(finish, Finish, FINISH)                                                          \
    X(framebufferRenderbuffer, FramebufferRenderbuffer, FRAMEBUFFERRENDERBUFFER)       \
    X(framebufferTexture2D, FramebufferTexture2D, FRAMEBUFFERTEXTURE2D)                \
    X(frontFace, FrontFace, FRONTFACE)                                                 \
    X(genBuffers, GenBuffers, GENBUFFERS)                                              \
    X(genFramebuffers, GenFramebuffers, GENFRAMEBUFFERS)                               \
    X(genQueries, GenQueries, GENQUERIES)                                              \
    X(genRenderbuffers, GenRenderbuffers, GENRENDERBUFFERS)                            \
    X(genSamplers, GenSamplers, GENSAMPLERS)                                           \
    X(genTextures, GenTextures, GENTEXTURES)                                           \
    X(genVertexArrays, GenVertexArrays, GENVERTEXARRAYS)                               \
    X(generateMipmap, GenerateMipmap, GENERATEMIPMAP)                                  \
    X(getActiveAttrib, GetActiveAttrib, GETACTIVEATTRIB)                               \
    X(getActiveUniformBlockName, GetActiveUniformBlockName, GETACTIVEUNIFORMBLOCKNAME) \
    X(getActiveUniformBlockiv, GetActiveUniformBlockiv, GETACTIVEUNIFORMBLOCKIV)       \
    X(getActiveUniformsiv, GetActiveUniformsiv, GETACTIVEUNIFORMSIV)                   \
    X(getActiveUniform, GetActiveUniform, GETACTIVEUNIFORM)                            \
    X(getAttribLocation, GetAttribLocation, GETATTRIBLOCATION)                         \
    X(getError, GetError, GETERROR)                                                    \
    X(getIntegerv, GetIntegerv, GETINTEGERV)                                           \
    X(getProgramInfoLog, GetProgramInfoLog, GETPROGRAMINFOLOG)                         \
    X(getProgramiv, GetProgramiv, GETPROGRAMIV)                                        \
    X(getQueryObjectui64v, GetQueryObjectui64v, GETQUERYOBJECTUI64V)                   \
    X(getQueryiv, GetQueryiv, GETQUERYIV)                                              \
    X(getShaderInfoLog, GetShaderInfoLog, GETSHADERINFOLOG)                            \
    X(getShaderiv, GetShaderiv, GETSHADERIV)                                           \
    X(getString, GetString, GETSTRING)                                                 \
    X(getUniformLocation, GetUniformLocation, GETUNIFORMLOCATION)                      \
    X(linkProgram, LinkProgram, LINKPROGRAM)                                           \
    X(pixelStorei, PixelStorei, PIXELSTOREI)                                           \
    X(readPixels, ReadPixels, READPIXELS)                                              \
    X(renderbufferStorage, RenderbufferStorage, RENDERBUFFERSTORAGE)                   \
    X(samplerParameterfv, SamplerParameterfv, SAMPLERPARAMETERFV)                      \
    X(samplerParameteri, SamplerParameteri, SAMPLERPARAMETERI)                         \
    X(shaderSource, ShaderSource, SHADERSOURCE)                                        \
    X(texImage2D, TexImage2D, TEXIMAGE2D)                                              \
    X(texParameteri, TexParameteri, TEXPARAMETERI)                                     \
    X(uniformBlockBinding, UniformBlockBinding, UNIFORMBLOCKBINDING)                   \
    X(uniform1fv, Uniform1fv, UNIFORM1FV)                                              \
    X(uniform2fv, Uniform2fv, UNIFORM2FV)                                              \
    X(uniform3fv, Uniform3fv, UNIFORM3FV)                                              \
    X(uniform4fv, Uniform4fv, UNIFORM4FV)                                              \
    X(uniform1iv, Uniform1iv, UNIFORM1IV)                                              \
    X(uniform2iv, Uniform2iv, UNIFORM2IV)                                              \
    X(uniform3iv, Uniform3iv, UNIFORM3IV)                                              \
    X(uniform4iv, Uniform4iv, UNIFORM4IV)                                              \
    X(uniformMatrix3fv, UniformMatrix3fv, UNIFORMMATRIX3FV)                            \
    X(uniformMatrix4fv, UniformMatrix4fv, UNIFORMMATRIX4FV)                            \
    X(useProgram, UseProgram, USEPROGRAM)                                              \
    X(vertexAttrib4fv, VertexAttrib4fv, VERTEXATTRIB4FV)                               \
    X(vertexAttribPointer, VertexAttribPointer, VERTEXATTRIBPOINTER)                   \
    X(viewport, Viewport, VIEWPORT)

// The driver's functions: `gl.clear(…)` is glClear.
struct Gl {
#define SHADERX_GL_MEMBER(ours, theirs, type) PFNGL##type##PROC ours = nullptr;
    SHADERX_GL_FUNCTIONS(SHADERX_GL_MEMBER)
#undef SHADERX_GL_MEMBER
};

// One context of the machine's driver. The library and its display stay for the life of the process, as EGL shares them
// between all users.
class Driver {
  public:
    // None after reporting no-driver.
    static std::unique_ptr<Driver> open(Diagnostics& diagnostics);
    ~Driver();
    Driver(const Driver&) = delete;
    Driver& operator=(const Driver&) = delete;

    bool makeCurrent() const;

    Gl gl;
    std::string renderer;

  private:
    Driver() = default;
    std::string start();

    PFNEGLGETPROCADDRESSPROC getProcAddress_ = nullptr;
    PFNEGLMAKECURRENTPROC makeCurrent_ = nullptr;
    PFNEGLDESTROYCONTEXTPROC destroyContext_ = nullptr;
    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace shaderx::draw
