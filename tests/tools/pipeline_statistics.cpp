// Statistics of a Vulkan driver's compiler for compute shaders: registers, spills, scratch, instructions. No device is
// needed if the driver compiles for an absent one (RADV_FORCE_FAMILY); scripts/shader_statistics builds and runs this.
//
//   pipeline_statistics FILE.spv...    one line per shader and statistic: file, name, value; separated by tabs
#include <vulkan/vulkan.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

namespace {

void require(VkResult result, const char* what) {
  if (result == VK_SUCCESS || result == VK_INCOMPLETE) return;
  std::fprintf(stderr, "%s failed: VkResult %d\n", what, int(result));
  std::exit(1);
}

std::vector<uint32_t> words_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  std::vector<uint32_t> words(bytes.size() / 4);
  std::copy_n(bytes.data(), words.size() * 4, reinterpret_cast<char*>(words.data()));
  return words;
}

// Bindings of a shader in set 0, from its decorations, types and variables (SPIR-V specification, section 3).
std::vector<VkDescriptorSetLayoutBinding> bindings_of(const std::vector<uint32_t>& words) {
  enum { type_image = 25, type_sampled_image = 27, type_pointer = 32, variable = 59, decorate = 71 };
  enum { block_as_buffer = 3, binding_decoration = 33, uniform = 2, uniform_constant = 0, storage_buffer = 12 };
  std::map<uint32_t, uint32_t> pointee, numbers;
  std::map<uint32_t, bool> old_buffer;
  std::vector<VkDescriptorSetLayoutBinding> result;
  for (std::size_t at = 5; at < words.size(); at += words[at] >> 16) {
    const uint32_t* w = &words[at];
    const uint32_t code = w[0] & 0xffff;
    if (code == decorate && w[2] == binding_decoration) numbers[w[1]] = w[3];
    if (code == decorate && w[2] == block_as_buffer) old_buffer[w[1]] = true;
    if (code == type_pointer) pointee[w[1]] = w[3];
    if (code != variable || numbers.count(w[2]) == 0) continue;
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    if (w[3] == storage_buffer || (w[3] == uniform && old_buffer[pointee[w[1]]]))
      type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    if (w[3] == uniform_constant) type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    result.push_back({numbers[w[2]], type, 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
  }
  return result;
}

VkDevice make_device() {
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO, nullptr, "airlight", 0, "", 0, VK_API_VERSION_1_1};
  VkInstanceCreateInfo instance_info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  instance_info.pApplicationInfo = &application;
  VkInstance instance;
  require(vkCreateInstance(&instance_info, nullptr, &instance), "vkCreateInstance");
  uint32_t count = 1;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  require(vkEnumeratePhysicalDevices(instance, &count, &physical), "vkEnumeratePhysicalDevices");
  if (count == 0) require(VK_ERROR_INITIALIZATION_FAILED, "finding a device");
  VkPhysicalDeviceProperties properties;
  vkGetPhysicalDeviceProperties(physical, &properties);
  std::printf("device\t%s\t\n", properties.deviceName);
  VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR executable{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR, nullptr, VK_TRUE};
  VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &executable, {}};
  features.features.shaderFloat64 = VK_TRUE;
  const float priority = 1;
  const VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, nullptr, 0, 0, 1, &priority};
  const char* extensions[] = {VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME};
  const VkDeviceCreateInfo info{
      VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features, 0, 1, &queue, 0, nullptr, 1, extensions, nullptr};
  VkDevice device;
  require(vkCreateDevice(physical, &info, nullptr, &device), "vkCreateDevice");
  return device;
}

VkPipeline make_pipeline(VkDevice device, const std::vector<uint32_t>& words) {
  const VkShaderModuleCreateInfo module_info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, nullptr, 0, words.size() * 4,
                                             words.data()};
  VkShaderModule module;
  require(vkCreateShaderModule(device, &module_info, nullptr, &module), "vkCreateShaderModule");
  const auto bindings = bindings_of(words);
  const VkDescriptorSetLayoutCreateInfo set_info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, nullptr, 0,
                                                 uint32_t(bindings.size()), bindings.data()};
  VkDescriptorSetLayout set;
  require(vkCreateDescriptorSetLayout(device, &set_info, nullptr, &set), "vkCreateDescriptorSetLayout");
  const VkPipelineLayoutCreateInfo layout_info{
      VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO, nullptr, 0, 1, &set, 0, nullptr};
  VkPipelineLayout layout;
  require(vkCreatePipelineLayout(device, &layout_info, nullptr, &layout), "vkCreatePipelineLayout");
  const VkPipelineShaderStageCreateInfo stage{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                              nullptr,
                                              0,
                                              VK_SHADER_STAGE_COMPUTE_BIT,
                                              module,
                                              "main",
                                              nullptr};
  const VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                         nullptr,
                                         VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR,
                                         stage,
                                         layout,
                                         VK_NULL_HANDLE,
                                         0};
  VkPipeline pipeline;
  require(vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline), "vkCreateComputePipelines");
  return pipeline;
}

void print_statistics(VkDevice device, VkPipeline pipeline, const std::string& file) {
  const auto get = reinterpret_cast<PFN_vkGetPipelineExecutableStatisticsKHR>(
      vkGetDeviceProcAddr(device, "vkGetPipelineExecutableStatisticsKHR"));
  const VkPipelineExecutableInfoKHR of{VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR, nullptr, pipeline, 0};
  uint32_t count = 0;
  require(get(device, &of, &count, nullptr), "vkGetPipelineExecutableStatisticsKHR");
  std::vector<VkPipelineExecutableStatisticKHR> all(count, {VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR});
  require(get(device, &of, &count, all.data()), "vkGetPipelineExecutableStatisticsKHR");
  for (const auto& s : all)
    std::printf("%s\t%s\t%.17g\n", file.c_str(), s.name,
                s.format == VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_FLOAT64_KHR ? s.value.f64 : double(s.value.u64));
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** files) {
  const VkDevice device = make_device();
  for (int i = 1; i < count; ++i) print_statistics(device, make_pipeline(device, words_of(files[i])), files[i]);
}
