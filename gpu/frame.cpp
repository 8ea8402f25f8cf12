#include "gpu/frame.h"

#include <chrono>

namespace airlight::gpu {
namespace {

constexpr GLbitfield mapping = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;

}  // namespace

Buffer& FrameBuffers::get(const std::string& name, std::size_t bytes) {
  auto& buffer = buffers_[name];
  if (!buffer || buffer->bytes() != bytes) {
    buffer.reset();  // first, so that both need not fit
    buffer = std::make_unique<Buffer>(context_, name, bytes, Contents::undefined);
  }
  return *buffer;
}

void FrameBuffers::poison() {
  for (auto& [name, buffer] : buffers_)
    if (buffer) buffer->poison();
}

void Download::begin(const std::optional<std::set<std::string>>& layers) {
  layers_ = layers;
  parts_.clear();
  values_.clear();
}

void Download::add(const std::string& layer, const Buffer& buffer, std::size_t bytes) {
  if (wants(layer) && bytes > 0) parts_.push_back({layer, &buffer, bytes, true});
}

void Download::add_values(const std::string& name, const Buffer& buffer, std::size_t bytes) {
  if (wants_any() && bytes > 0) parts_.push_back({name, &buffer, bytes, false});
}

void Download::add_status(const std::string& name, const Buffer& buffer, std::size_t bytes) {
  parts_.push_back({name, &buffer, bytes, false});
}

void Download::reserve(std::size_t bytes) {
  if (bytes <= bytes_) return;
  const Gl& gl = context_.gl();
  id_ = Handle();
  bytes_ = 0;
  GLuint id = 0;
  gl.CreateBuffers(1, &id);
  id_ = Handle(context_, id, [](const Gl& gl, GLuint id) { gl.DeleteBuffers(1, &id); });  // unmaps it
  gl.NamedBufferStorage(id_, GLsizeiptr(bytes), nullptr, mapping | GL_CLIENT_STORAGE_BIT);
  ++context_.traffic().allocations;
  context_.check("making the buffer of downloads");
  mapped_ = static_cast<const char*>(gl.MapNamedBufferRange(id_, 0, GLsizeiptr(bytes), mapping));
  context_.check("mapping the buffer of downloads");
  bytes_ = bytes;
}

void Download::copy() {
  std::size_t bytes = 0;
  for (const Part& part : parts_) bytes += part.bytes;
  reserve(bytes);
  std::size_t at = 0;
  for (const Part& part : parts_) {
    part.buffer->copy_to(id_, at, part.bytes);
    at += part.bytes;
  }
  context_.gl().MemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
  context_.traffic().bytes_down += long(bytes);
}

void Download::fetch(scene::Film& film) {
  const char* from = mapped_;
  for (const Part& part : parts_) {
    if (part.layer) {
      std::vector<float>& layer = film.layers[part.name];
      layer.resize(part.bytes / sizeof(float));
      std::memcpy(layer.data(), from, layer.size() * sizeof(float));
    } else {
      values_[part.name].assign(from, from + part.bytes);
    }
    from += part.bytes;
  }
}

std::vector<scene::StageTime>& host_times_of_last_frame() {
  static std::vector<scene::StageTime> times;
  return times;
}

void Frame::begin(const scene::Execution& execution) {
  const Use use(context_);
  before_ = context_.traffic();
  download.begin(execution.layers);
  if (poisoned()) buffers.poison();
  timer.restart();
}

void Frame::finish(scene::Rendering& rendering) {
  const Use use(context_);
  const bool downloads = download.wants_any() || !download.empty();
  if (downloads) {
    timer.begin("download");
    download.copy();
  }
  rendering.times = timer.times();
  host_times_of_last_frame() = timer.host_times();
  const auto start = std::chrono::steady_clock::now();
  download.fetch(rendering.film);
  if (downloads)  // what the host adds to the device's copies
    rendering.times.back().seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  context_.check("a frame");
  for (const auto& [name, value] : (context_.traffic() - before_).counters()) rendering.counters[name] = value;
}

}  // namespace airlight::gpu
