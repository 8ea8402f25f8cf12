// The entry points of EGL and OpenGL 4.5 core that are used here, fetched at run time: the program links neither and
// starts on machines that have no graphics library at all.
#pragma once
#include <GL/glcorearb.h>

namespace airlight::gpu {

// clang-format off
#define AIRLIGHT_GL_FUNCTIONS(X)                                                                                     \
  /* context */                                                                                                      \
  X(PFNGLGETSTRINGPROC, GetString) X(PFNGLGETINTEGERVPROC, GetIntegerv) X(PFNGLGETINTEGER64VPROC, GetInteger64v)     \
  X(PFNGLGETINTEGERI_VPROC, GetIntegeri_v) X(PFNGLENABLEPROC, Enable) X(PFNGLDISABLEPROC, Disable)                   \
  X(PFNGLDEBUGMESSAGECALLBACKPROC, DebugMessageCallback) X(PFNGLDEBUGMESSAGECONTROLPROC, DebugMessageControl)        \
  X(PFNGLFINISHPROC, Finish) X(PFNGLGETSTRINGIPROC, GetStringi)                                                      \
  /* programs */                                                                                                     \
  X(PFNGLCREATESHADERPROC, CreateShader) X(PFNGLSHADERSOURCEPROC, ShaderSource)                                      \
  X(PFNGLCOMPILESHADERPROC, CompileShader) X(PFNGLGETSHADERIVPROC, GetShaderiv)                                      \
  X(PFNGLGETSHADERINFOLOGPROC, GetShaderInfoLog) X(PFNGLDELETESHADERPROC, DeleteShader)                              \
  X(PFNGLCREATEPROGRAMPROC, CreateProgram) X(PFNGLATTACHSHADERPROC, AttachShader)                                    \
  X(PFNGLLINKPROGRAMPROC, LinkProgram) X(PFNGLGETPROGRAMIVPROC, GetProgramiv)                                        \
  X(PFNGLGETPROGRAMINFOLOGPROC, GetProgramInfoLog) X(PFNGLDELETEPROGRAMPROC, DeleteProgram)                          \
  X(PFNGLUSEPROGRAMPROC, UseProgram) X(PFNGLGETUNIFORMLOCATIONPROC, GetUniformLocation)                              \
  X(PFNGLPROGRAMUNIFORM1IPROC, ProgramUniform1i) X(PFNGLPROGRAMUNIFORM2IPROC, ProgramUniform2i)                      \
  X(PFNGLPROGRAMUNIFORM3IPROC, ProgramUniform3i) X(PFNGLPROGRAMUNIFORM1FPROC, ProgramUniform1f)                      \
  X(PFNGLPROGRAMUNIFORM2FPROC, ProgramUniform2f) X(PFNGLPROGRAMUNIFORM3FPROC, ProgramUniform3f)                      \
  X(PFNGLPROGRAMUNIFORM4FPROC, ProgramUniform4f) X(PFNGLPROGRAMUNIFORMMATRIX3FVPROC, ProgramUniformMatrix3fv)        \
  X(PFNGLPROGRAMUNIFORMMATRIX4FVPROC, ProgramUniformMatrix4fv)                                                       \
  X(PFNGLDISPATCHCOMPUTEPROC, DispatchCompute) X(PFNGLMEMORYBARRIERPROC, MemoryBarrier)                              \
  /* buffers */                                                                                                      \
  X(PFNGLCREATEBUFFERSPROC, CreateBuffers) X(PFNGLDELETEBUFFERSPROC, DeleteBuffers)                                  \
  X(PFNGLNAMEDBUFFERSTORAGEPROC, NamedBufferStorage) X(PFNGLNAMEDBUFFERSUBDATAPROC, NamedBufferSubData)              \
  X(PFNGLGETNAMEDBUFFERSUBDATAPROC, GetNamedBufferSubData) X(PFNGLCLEARNAMEDBUFFERDATAPROC, ClearNamedBufferData)    \
  X(PFNGLBINDBUFFERBASEPROC, BindBufferBase)                                                                         \
  /* textures */                                                                                                     \
  X(PFNGLCREATETEXTURESPROC, CreateTextures) X(PFNGLDELETETEXTURESPROC, DeleteTextures)                              \
  X(PFNGLTEXTURESTORAGE3DPROC, TextureStorage3D) X(PFNGLTEXTURESUBIMAGE3DPROC, TextureSubImage3D)                    \
  X(PFNGLTEXTURESTORAGE2DPROC, TextureStorage2D) X(PFNGLTEXTURESUBIMAGE2DPROC, TextureSubImage2D)                    \
  X(PFNGLTEXTUREPARAMETERIPROC, TextureParameteri) X(PFNGLTEXTUREPARAMETERFVPROC, TextureParameterfv)                \
  X(PFNGLBINDTEXTUREUNITPROC, BindTextureUnit) X(PFNGLGETTEXTUREIMAGEPROC, GetTextureImage)                          \
  X(PFNGLPIXELSTOREIPROC, PixelStorei)                                                                               \
  /* timestamps */                                                                                                   \
  X(PFNGLCREATEQUERIESPROC, CreateQueries) X(PFNGLDELETEQUERIESPROC, DeleteQueries)                                  \
  X(PFNGLQUERYCOUNTERPROC, QueryCounter) X(PFNGLGETQUERYOBJECTUI64VPROC, GetQueryObjectui64v)                        \
  /* raster */                                                                                                       \
  X(PFNGLCREATEFRAMEBUFFERSPROC, CreateFramebuffers) X(PFNGLDELETEFRAMEBUFFERSPROC, DeleteFramebuffers)              \
  X(PFNGLNAMEDFRAMEBUFFERTEXTUREPROC, NamedFramebufferTexture)                                                       \
  X(PFNGLNAMEDFRAMEBUFFERTEXTURELAYERPROC, NamedFramebufferTextureLayer)                                             \
  X(PFNGLNAMEDFRAMEBUFFERDRAWBUFFERSPROC, NamedFramebufferDrawBuffers)                                               \
  X(PFNGLCHECKNAMEDFRAMEBUFFERSTATUSPROC, CheckNamedFramebufferStatus)                                               \
  X(PFNGLCLEARNAMEDFRAMEBUFFERFVPROC, ClearNamedFramebufferfv) X(PFNGLBINDFRAMEBUFFERPROC, BindFramebuffer)          \
  X(PFNGLCREATEVERTEXARRAYSPROC, CreateVertexArrays) X(PFNGLDELETEVERTEXARRAYSPROC, DeleteVertexArrays)              \
  X(PFNGLBINDVERTEXARRAYPROC, BindVertexArray) X(PFNGLDRAWARRAYSPROC, DrawArrays)                                    \
  X(PFNGLVIEWPORTPROC, Viewport) X(PFNGLDEPTHFUNCPROC, DepthFunc) X(PFNGLCLIPCONTROLPROC, ClipControl)
// clang-format on

// The functions under their names without "gl".
struct Gl {
#define AIRLIGHT_DECLARE(type, name) type name = nullptr;
  AIRLIGHT_GL_FUNCTIONS(AIRLIGHT_DECLARE)
#undef AIRLIGHT_DECLARE
};

}  // namespace airlight::gpu
