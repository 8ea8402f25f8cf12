// The entry points of OpenGL 4.5 core that are used here, fetched at run time: nothing is linked, and the program
// starts on machines that have no graphics library at all. A new one is a word in this list.
#pragma once
#include <GL/glcorearb.h>

namespace airlight::gpu {

// clang-format off
#define AIRLIGHT_GL_FUNCTIONS(X)                                                                                     \
  /* context */                                                                                                      \
  X(PFNGLGETINTEGERVPROC, GetIntegerv) X(PFNGLGETINTEGER64VPROC, GetInteger64v)                                      \
  X(PFNGLGETINTEGERI_VPROC, GetIntegeri_v) X(PFNGLENABLEPROC, Enable)                                                \
  X(PFNGLGETERRORPROC, GetError)                                                                                     \
  X(PFNGLDEBUGMESSAGECALLBACKPROC, DebugMessageCallback) X(PFNGLOBJECTLABELPROC, ObjectLabel)                        \
  X(PFNGLPUSHDEBUGGROUPPROC, PushDebugGroup) X(PFNGLPOPDEBUGGROUPPROC, PopDebugGroup)                                \
  X(PFNGLFENCESYNCPROC, FenceSync) X(PFNGLCLIENTWAITSYNCPROC, ClientWaitSync) X(PFNGLDELETESYNCPROC, DeleteSync)     \
  /* programs */                                                                                                     \
  X(PFNGLCREATESHADERPROC, CreateShader) X(PFNGLSHADERSOURCEPROC, ShaderSource)                                      \
  X(PFNGLCOMPILESHADERPROC, CompileShader) X(PFNGLGETSHADERIVPROC, GetShaderiv)                                      \
  X(PFNGLGETSHADERINFOLOGPROC, GetShaderInfoLog) X(PFNGLDELETESHADERPROC, DeleteShader)                              \
  X(PFNGLCREATEPROGRAMPROC, CreateProgram) X(PFNGLATTACHSHADERPROC, AttachShader)                                    \
  X(PFNGLLINKPROGRAMPROC, LinkProgram) X(PFNGLGETPROGRAMIVPROC, GetProgramiv)                                        \
  X(PFNGLGETPROGRAMINFOLOGPROC, GetProgramInfoLog) X(PFNGLDELETEPROGRAMPROC, DeleteProgram)                          \
  X(PFNGLGETPROGRAMRESOURCEINDEXPROC, GetProgramResourceIndex)                                                        \
  X(PFNGLGETPROGRAMRESOURCEIVPROC, GetProgramResourceiv)                                                              \
  X(PFNGLUSEPROGRAMPROC, UseProgram) X(PFNGLGETUNIFORMLOCATIONPROC, GetUniformLocation)                              \
  X(PFNGLGETPROGRAMINTERFACEIVPROC, GetProgramInterfaceiv)                                                           \
  X(PFNGLPROGRAMUNIFORM1IPROC, ProgramUniform1i) X(PFNGLPROGRAMUNIFORM1FPROC, ProgramUniform1f)                      \
  X(PFNGLPROGRAMUNIFORM3FPROC, ProgramUniform3f) X(PFNGLPROGRAMUNIFORMMATRIX3FVPROC, ProgramUniformMatrix3fv)        \
  X(PFNGLPROGRAMUNIFORM1DPROC, ProgramUniform1d) X(PFNGLPROGRAMUNIFORM3DPROC, ProgramUniform3d)                      \
  X(PFNGLDISPATCHCOMPUTEPROC, DispatchCompute) X(PFNGLMEMORYBARRIERPROC, MemoryBarrier)                              \
  X(PFNGLDISPATCHCOMPUTEINDIRECTPROC, DispatchComputeIndirect)                                                       \
  /* buffers */                                                                                                      \
  X(PFNGLCREATEBUFFERSPROC, CreateBuffers) X(PFNGLDELETEBUFFERSPROC, DeleteBuffers)                                  \
  X(PFNGLNAMEDBUFFERSTORAGEPROC, NamedBufferStorage) X(PFNGLNAMEDBUFFERSUBDATAPROC, NamedBufferSubData)              \
  X(PFNGLGETNAMEDBUFFERSUBDATAPROC, GetNamedBufferSubData) X(PFNGLCLEARNAMEDBUFFERDATAPROC, ClearNamedBufferData)    \
  X(PFNGLBINDBUFFERBASEPROC, BindBufferBase) X(PFNGLBINDBUFFERPROC, BindBuffer)                                      \
  X(PFNGLCOPYNAMEDBUFFERSUBDATAPROC, CopyNamedBufferSubData) X(PFNGLMAPNAMEDBUFFERRANGEPROC, MapNamedBufferRange)    \
  /* raster passes */                                                                                                \
  X(PFNGLCREATEFRAMEBUFFERSPROC, CreateFramebuffers) X(PFNGLDELETEFRAMEBUFFERSPROC, DeleteFramebuffers)              \
  X(PFNGLNAMEDFRAMEBUFFERTEXTUREPROC, NamedFramebufferTexture)                                                       \
  X(PFNGLNAMEDFRAMEBUFFERDRAWBUFFERSPROC, NamedFramebufferDrawBuffers)                                               \
  X(PFNGLNAMEDFRAMEBUFFERREADBUFFERPROC, NamedFramebufferReadBuffer)                                                 \
  X(PFNGLCHECKNAMEDFRAMEBUFFERSTATUSPROC, CheckNamedFramebufferStatus)                                               \
  X(PFNGLCLEARNAMEDFRAMEBUFFERFVPROC, ClearNamedFramebufferfv)                                                       \
  X(PFNGLCLEARNAMEDFRAMEBUFFERUIVPROC, ClearNamedFramebufferuiv) X(PFNGLBINDFRAMEBUFFERPROC, BindFramebuffer)          \
  X(PFNGLCREATETEXTURESPROC, CreateTextures) X(PFNGLDELETETEXTURESPROC, DeleteTextures)                              \
  X(PFNGLTEXTURESTORAGE2DPROC, TextureStorage2D) X(PFNGLREADPIXELSPROC, ReadPixels)                                  \
  X(PFNGLVIEWPORTPROC, Viewport) X(PFNGLDEPTHFUNCPROC, DepthFunc)                                                    \
  X(PFNGLCREATEVERTEXARRAYSPROC, CreateVertexArrays) X(PFNGLDELETEVERTEXARRAYSPROC, DeleteVertexArrays)              \
  X(PFNGLBINDVERTEXARRAYPROC, BindVertexArray) X(PFNGLDRAWARRAYSINSTANCEDPROC, DrawArraysInstanced)                  \
  /* textures of voxels */                                                                                           \
  X(PFNGLTEXTURESTORAGE3DPROC, TextureStorage3D) X(PFNGLTEXTURESUBIMAGE3DPROC, TextureSubImage3D)                    \
  X(PFNGLGETTEXTURESUBIMAGEPROC, GetTextureSubImage) X(PFNGLTEXTUREPARAMETERIPROC, TextureParameteri)                \
  X(PFNGLBINDTEXTUREUNITPROC, BindTextureUnit)                                                                       \
  /* timestamps */                                                                                                   \
  X(PFNGLCREATEQUERIESPROC, CreateQueries) X(PFNGLDELETEQUERIESPROC, DeleteQueries)                                  \
  X(PFNGLQUERYCOUNTERPROC, QueryCounter) X(PFNGLGETQUERYOBJECTUI64VPROC, GetQueryObjectui64v)                        \
  X(PFNGLGENQUERIESPROC, GenQueries) X(PFNGLBEGINQUERYPROC, BeginQuery) X(PFNGLENDQUERYPROC, EndQuery)
// clang-format on

// The functions under their names without "gl".
struct Gl {
#define AIRLIGHT_DECLARE(type, name) type name = nullptr;
  AIRLIGHT_GL_FUNCTIONS(AIRLIGHT_DECLARE)
#undef AIRLIGHT_DECLARE
};

}  // namespace airlight::gpu
