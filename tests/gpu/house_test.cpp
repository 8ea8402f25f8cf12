// The GPU house: context, programs, buffers, timers, and how each fails.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>

#include "gpu/buffer.h"
#include "gpu/device_choice.h"
#include "gpu/kernel_drivers.h"
#include "gpu/program.h"
#include "gpu/shader_source.h"
#include "gpu/timer.h"
#include "tests/gpu/device.h"
#include "tests/gpu/shader_folder.h"

namespace house_test {

using namespace airlight;
using namespace airlight::gpu;
using test::ShaderFolder;

namespace {

const char* const doubling = R"(layout(local_size_x = LOCAL_SIZE_X) in;
layout(std430, binding = 0) buffer Values { float values[]; };
uniform int count;
uniform float factor;
void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i < count) values[i] *= factor;
}
)";

}  // namespace

DEVICE_TEST_CASE("every place is tried, and the one chosen works", "[gpu]") {
  int working = 0;
  for (const Attempt& a : Context::try_everything()) {
    CHECK(a.failure.empty() != a.renderer.empty());
    working += a.failure.empty();
  }
  CHECK(working > 0);
  CHECK(&context == &Context::get());
  CHECK(context.limits().storage_block >= std::size_t(1) << 24);
  CHECK(context.limits().groups[0] >= 65535);
  CHECK(context.description().find(context.renderer()) == 0);
}

TEST_CASE("a device is chosen by number, by place or by a part of its names", "[gpu-choice]") {
  const Attempt fast{{"device 1", false, nullptr}, "GeForce 4090", "NVIDIA Corporation", "4.6", ""},
      soft{{"surfaceless", true, nullptr}, "llvmpipe (LLVM 15)", "Mesa", "4.5", ""},
      broken{{"device 0", false, nullptr}, "", "", "", "device 0: eglInitialize: EGL_NOT_INITIALIZED (0x3001)"};
  for (const char* wish : {"auto", "1", "device 1", "nvidia", "geforce"}) CHECK(fits(fast, wish));
  for (const char* wish : {"none", "0", "4", "device 0", "surfaceless", "mesa"}) CHECK_FALSE(fits(fast, wish));
  for (const char* wish : {"auto", "surfaceless", "llvmpipe", "mesa"}) CHECK(fits(soft, wish));
  CHECK_FALSE(fits(soft, "15"));  // a number counts devices
  CHECK(refusal({broken, fast, soft}, "amd") ==
        "gpu: no device 'amd' that works; there is device 0: eglInitialize: EGL_NOT_INITIALIZED (0x3001); device 1: "
        "GeForce 4090, NVIDIA Corporation; surfaceless: llvmpipe (LLVM 15), Mesa");
  CHECK(refusal({broken}, "auto") ==
        "gpu: no device works; there is device 0: eglInitialize: EGL_NOT_INITIALIZED (0x3001)");
  CHECK(refusal({}, "auto") == "gpu: EGL lists no device and no surfaceless platform: CPU only");
}

TEST_CASE("a kernel driver without its EGL is told", "[gpu-choice]") {
  const Attempt soft{{"surfaceless", true, nullptr}, "llvmpipe (LLVM 15)", "Mesa", "4.5", ""},
      nvidia{{"device 0", false, nullptr}, "Tesla", "NVIDIA Corporation", "4.6", ""},
      failed{{"device 0", false, nullptr}, "", "NVIDIA Corporation", "", "device 0: eglInitialize"};
  const TemporaryFolder root;
  const auto lines = [&](const std::vector<Attempt>& attempts) { return drivers_without_egl(attempts, root.path()); };
  CHECK(lines({soft}).empty());
  std::filesystem::create_directories(root.path() / "dev/dri");
  CHECK(lines({soft}).empty());
  root.write("dev/dri/renderD128", "");
  REQUIRE(lines({soft}).size() == 1);
  CHECK_THAT(lines({soft})[0], Catch::Contains("/dev/dri/renderD"));
  CHECK(lines({soft, nvidia}).empty());
  std::filesystem::create_directories(root.path() / "proc/driver/nvidia");
  CHECK(lines({soft, nvidia}).empty());
  CHECK(lines({soft, failed}).size() == 2);
  CHECK_THAT(lines({soft, failed})[0], Catch::Contains("/proc/driver/nvidia") && Catch::Contains("its EGL is not"));
  root.write("dev/kfd", "");
  CHECK_THAT(lines({soft, nvidia})[0], Catch::Contains("/dev/kfd"));
}

// A driver with holes in it: a stand-in for its eglGetProcAddress.
TEST_CASE("a context that lacks something is known by it", "[gpu-choice]") {
  static GLint minor;
  const PFNGLGETINTEGERVPROC version = [](GLenum name, GLint* value) { *value = name == GL_MAJOR_VERSION ? 4 : minor; };
  const auto driver = [&](std::vector<std::string> holes) {
    return [version, holes](const char* name) -> void* {
      if (std::find(holes.begin(), holes.end(), name) != holes.end()) return nullptr;
      return reinterpret_cast<void*>(version);  // never called under other names
    };
  };
  Gl gl;
  minor = 6;
  CHECK(load_gl(driver({}), gl).empty());
  CHECK(load_gl(driver({"glDispatchCompute"}), gl) == "lacks glDispatchCompute");
  CHECK(load_gl(driver({"glEnable", "glViewport", "glDispatchCompute", "glReadPixels", "glDepthFunc"}), gl) ==
        "lacks glEnable, glDispatchCompute, glReadPixels and 2 more");
  minor = 3;
  CHECK(load_gl(driver({}), gl) == "has OpenGL 4.3, expected 4.5");
}

DEVICE_TEST_CASE("the device cannot be changed once it is in use", "[gpu]") {
  CHECK_THROWS_WITH(Context::choose_device("surfaceless"), Catch::Contains("in use already"));
  CHECK_THROWS_WITH(Context::choose_device(""), Catch::Contains("no name of a device"));
}

DEVICE_TEST_CASE("a program runs over a buffer, and only within it", "[gpu]") {
  const ShaderFolder shaders(doubling);
  const Use use(context);
  std::vector<float> values(1000);
  for (int i = 0; i < 1000; ++i) values[i] = float(i);
  Buffer buffer(context, "values", values);
  Program program(context, "test.comp", {{"LOCAL_SIZE_X", "64"}});
  program.set("count", 990);  // the rest is a guard zone; 1000 is no multiple of 64 either
  program.set("factor", 2.0);
  buffer.bind(0);
  const long before = Program::dispatches();
  program.dispatch(990);
  program.dispatch(0);
  CHECK(Program::dispatches() - before == 1);  // nothing to do is no dispatch
  const std::vector<float> after = buffer.download<float>();
  for (int i = 0; i < 1000; ++i) CHECK(after[i] == (i < 990 ? 2.0f : 1.0f) * float(i));
}

DEVICE_TEST_CASE("a shader's error names its file and line", "[gpu]") {
  const ShaderFolder shaders("layout(local_size_x = 1) in;\n#include \"part.glsl\"\nvoid main() { wrong(); }\n");
  shaders.folder().write("part.glsl", "float right() { return 1; }\nfloat broken() { return nothing; }\n");
  CHECK_THROWS_WITH(Program(context, "test.comp", {}), Catch::Contains("gpu/part.glsl:2:"));
  shaders.folder().write("part.glsl", "float right() { return 1; }\n");
  CHECK_THROWS_WITH(Program(context, "test.comp", {}), Catch::Contains("gpu/test.comp:3:"));
  shaders.folder().write("part.glsl", "#include \"missing.glsl\"\n");
  CHECK_THROWS_WITH(Program(context, "test.comp", {}),
                    Catch::Contains("gpu/part.glsl:1: no shader") && Catch::Contains("missing.glsl"));
  // The context survives all of it.
  shaders.folder().write("test.comp", doubling);
  CHECK_NOTHROW(Program(context, "test.comp", {}));
}

TEST_CASE("errors of units in the last place are a whole number of them", "[gpu]") {
  const char* const before = std::getenv("AIRLIGHT_GPU_ULPS");
  const std::string kept = before ? before : "";
  for (const char* wrong : {"x", "2x", "1.5", "-1", "100000"}) {
    setenv("AIRLIGHT_GPU_ULPS", wrong, 1);
    CHECK_THROWS_WITH(shader_source("ray_marcher/march.comp", {}),
                      Catch::Contains(fmt::format("AIRLIGHT_GPU_ULPS = '{}': expected a whole number", wrong)));
  }
  setenv("AIRLIGHT_GPU_ULPS", "2", 1);
  CHECK_THAT(shader_source("ray_marcher/march.comp", {}).text, Catch::Contains("#define ULP_ERRORS 2\n"));
  before ? setenv("AIRLIGHT_GPU_ULPS", kept.c_str(), 1) : unsetenv("AIRLIGHT_GPU_ULPS");
}

TEST_CASE("messages of compilers are translated", "[gpu]") {
  const ShaderSource source{"", {"a.comp", "b.glsl"}};
  CHECK(with_file_names("1:12(3): error: no\n0:4(1): error: yes", source) ==
        "gpu/b.glsl:12: error: no\ngpu/a.comp:4: error: yes");
  CHECK(with_file_names("1(12) : error C1008: undefined", source) == "gpu/b.glsl:12: error C1008: undefined");
  CHECK(with_file_names("link error 7:x", source) == "link error 7:x");
}

DEVICE_TEST_CASE("misuse of the GPU is an error", "[gpu]") {
  const Use use(context);
  const ShaderFolder shaders(doubling);
  Program program(context, "test.comp", {});
  CHECK_THROWS_WITH(program.set("no_such_uniform", 1), Catch::Contains("no uniform 'no_such_uniform'"));
  context.gl().BindBufferBase(GL_SHADER_STORAGE_BUFFER, 9999, 0);
  CHECK_THROWS_WITH(context.check("this"), Catch::Contains("this failed on " + context.renderer()));
  CHECK_NOTHROW(context.check("once only"));
  const std::string too_many = std::to_string(2 * context.limits().invocations);
  CHECK_THROWS_AS(Program(context, "test.comp", {{"LOCAL_SIZE_X", too_many}}), Unavailable);
  CHECK_THROWS_WITH(Program(context, "test.comp", {{"LOCAL_SIZE_X", too_many}}),
                    Catch::Contains(too_many + " invocations") && Catch::Contains("offers at most"));
  CHECK_THROWS_AS(program.dispatch(1, context.limits().groups[1] + 1), Error);
  CHECK_THROWS_WITH(Buffer(context, "giant", context.limits().storage_block + 1),
                    Catch::Contains("'giant' needs") && Catch::Contains("offers at most"));
  CHECK_THROWS_AS(Buffer(context, "giant", context.limits().storage_block + 1), Unavailable);
}

DEVICE_TEST_CASE("more storage blocks than the device has are refused in one line", "[gpu]") {
  const auto with_blocks = [](int count) {
    std::string text = "layout(local_size_x = 1) in;\n", body;
    for (int i = 0; i < count; ++i) {
      text += fmt::format("layout(std430, binding = {0}) buffer B{0} {{ float v{0}; }};\n", i);
      body += fmt::format("v{} += 1; ", i);
    }
    return text + "void main() { " + body + "}\n";
  };
  const int most = context.limits().storage_blocks;
  {
    const ShaderFolder shaders(with_blocks(most));
    CHECK_NOTHROW(Program(context, "test.comp", {}));
  }
  const ShaderFolder shaders(with_blocks(most + 1));
  CHECK_THROWS_AS(Program(context, "test.comp", {}), Unavailable);
  CHECK_THROWS_WITH(Program(context, "test.comp", {}),
                    Catch::Contains(fmt::format("{} storage blocks", most + 1)) && !Catch::Contains("\n"));
  CHECK_NOTHROW(context.check("nothing is left of it"));
}

DEVICE_TEST_CASE("stages are timed by the device", "[gpu]") {
  const Use use(context);
  const ShaderFolder shaders(doubling);
  const Buffer buffer(context, "values", std::vector<float>(1 << 20, 1.0f));
  Program program(context, "test.comp", {{"LOCAL_SIZE_X", "64"}});
  program.set("count", 1 << 20);
  program.set("factor", 1.0);
  buffer.bind(0);
  program.dispatch(1 << 20);
  StageTimer timer(context);
  program.dispatch(1 << 20);
  timer.stage("one");
  timer.stage("nothing");
  program.dispatch(1 << 20);
  timer.stage("one");
  const auto times = timer.times();
  REQUIRE(times.size() == 2);
  CHECK(times[0].name == "one");
  CHECK(times[0].seconds > 1e-7);
  CHECK(times[1].seconds < times[0].seconds);
}

}  // namespace house_test
