#include "cl/device.h"

#include <cstdlib>
#include <filesystem>
#include <sstream>

namespace wavelobe {
namespace {

template <class T>
T device_value(cl_device_id device, cl_device_info what) {
    T value{};
    CL_CHECK(clGetDeviceInfo(device, what, sizeof value, &value, nullptr));
    return value;
}

std::string device_text(cl_device_id device, cl_device_info what) {
    std::size_t size = 0;
    CL_CHECK(clGetDeviceInfo(device, what, 0, nullptr, &size));
    std::string text(size, '\0');
    CL_CHECK(clGetDeviceInfo(device, what, size, text.data(), nullptr));
    text.resize(size > 0 ? size - 1 : 0);
    return text;
}

std::string platform_text(cl_platform_id platform, cl_platform_info what) {
    std::size_t size = 0;
    CL_CHECK(clGetPlatformInfo(platform, what, 0, nullptr, &size));
    std::string text(size, '\0');
    CL_CHECK(clGetPlatformInfo(platform, what, size, text.data(), nullptr));
    text.resize(size > 0 ? size - 1 : 0);
    return text;
}

// What PoCL reads from the environment when the platform is first touched. A user's own settings win.
void configure_pocl(const DeviceOptions& options) {
    if (options.threads > 0) {
        const std::string count = std::to_string(options.threads);
        setenv("POCL_MAX_PTHREAD_COUNT", count.c_str(), 1);  // PoCL up to 3.1
        setenv("POCL_CPU_MAX_CU_COUNT", count.c_str(), 1);   // PoCL from 4.0 on
    }
    const std::string cache = kernel_cache_folder();
    std::error_code ignored;  // an unwritable cache is reported by `doctor`; PoCL then compiles every time
    std::filesystem::create_directories(cache, ignored);
    setenv("POCL_CACHE_DIR", cache.c_str(), 0);
}

DeviceInfo describe(cl_platform_id platform, cl_device_id device) {
    DeviceInfo info;
    info.name = device_text(device, CL_DEVICE_NAME);
    info.platform = platform_text(platform, CL_PLATFORM_NAME) + ", " + platform_text(platform, CL_PLATFORM_VERSION);
    info.driver = device_text(device, CL_DRIVER_VERSION);
    info.memory_bytes = device_value<cl_ulong>(device, CL_DEVICE_GLOBAL_MEM_SIZE);
    info.max_allocation_bytes = device_value<cl_ulong>(device, CL_DEVICE_MAX_MEM_ALLOC_SIZE);
    info.compute_units = device_value<cl_uint>(device, CL_DEVICE_MAX_COMPUTE_UNITS);
    info.native_float_width = device_value<cl_uint>(device, CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT);
    return info;
}

struct Candidate {
    cl_device_id id;
    DeviceInfo info;
};

std::vector<Candidate> list_cpu_devices() {
    cl_uint platform_count = 0;
    // Without any platform the loader answers with an error code of its own: an empty list is what that means.
    if (clGetPlatformIDs(0, nullptr, &platform_count) != CL_SUCCESS) platform_count = 0;
    std::vector<cl_platform_id> platforms(platform_count);
    if (platform_count > 0) CL_CHECK(clGetPlatformIDs(platform_count, platforms.data(), nullptr));
    std::vector<Candidate> found;
    for (cl_platform_id platform : platforms) {
        cl_uint count = 0;
        if (clGetDeviceIDs(platform, CL_DEVICE_TYPE_CPU, 0, nullptr, &count) != CL_SUCCESS) continue;
        std::vector<cl_device_id> devices(count);
        CL_CHECK(clGetDeviceIDs(platform, CL_DEVICE_TYPE_CPU, count, devices.data(), nullptr));
        for (cl_device_id device : devices) found.push_back({device, describe(platform, device)});
    }
    return found;
}

}  // namespace

std::string cl_error_name(cl_int code) {
    switch (code) {
        case CL_DEVICE_NOT_FOUND: return "CL_DEVICE_NOT_FOUND";
        case CL_MEM_OBJECT_ALLOCATION_FAILURE: return "CL_MEM_OBJECT_ALLOCATION_FAILURE";
        case CL_OUT_OF_RESOURCES: return "CL_OUT_OF_RESOURCES";
        case CL_OUT_OF_HOST_MEMORY: return "CL_OUT_OF_HOST_MEMORY";
        case CL_BUILD_PROGRAM_FAILURE: return "CL_BUILD_PROGRAM_FAILURE";
        case CL_INVALID_VALUE: return "CL_INVALID_VALUE";
        case CL_INVALID_KERNEL_NAME: return "CL_INVALID_KERNEL_NAME";
        case CL_INVALID_KERNEL_ARGS: return "CL_INVALID_KERNEL_ARGS";
        case CL_INVALID_ARG_INDEX: return "CL_INVALID_ARG_INDEX";
        case CL_INVALID_ARG_SIZE: return "CL_INVALID_ARG_SIZE";
        case CL_INVALID_WORK_GROUP_SIZE: return "CL_INVALID_WORK_GROUP_SIZE";
        case CL_INVALID_BUFFER_SIZE: return "CL_INVALID_BUFFER_SIZE";
        default: return "OpenCL error " + std::to_string(code);
    }
}

std::string kernel_cache_folder() {
    if (const char* set = std::getenv("POCL_CACHE_DIR"); set != nullptr && *set != '\0') return set;
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && *cache != '\0') {
        return std::string(cache) + "/wavelobe/pocl";
    }
    const char* home = std::getenv("HOME");
    return std::string(home != nullptr && *home != '\0' ? home : ".") + "/.cache/wavelobe/pocl";
}

Device::Device(const DeviceOptions& options) {
    configure_pocl(options);
    const std::vector<Candidate> candidates = list_cpu_devices();
    for (const Candidate& candidate : candidates) {
        const bool fits = options.name.empty() || candidate.info.name.find(options.name) != std::string::npos ||
                          candidate.info.platform.find(options.name) != std::string::npos;
        if (!fits) continue;
        id_ = candidate.id;
        info_ = candidate.info;
        break;
    }
    if (id_ == nullptr) {
        std::ostringstream message;
        if (candidates.empty()) {
            message << "no OpenCL CPU device found; install one (apt-get install pocl-opencl-icd) and see that its cache "
                    << kernel_cache_folder() << " can be written";
        } else {
            message << "no OpenCL CPU device named \"" << options.name << "\"; there are:";
            for (const Candidate& candidate : candidates) {
                message << "\n  " << candidate.info.name << " (" << candidate.info.platform << ")";
            }
        }
        throw ClError(message.str());
    }
    cl_int code = CL_SUCCESS;
    context_.reset(clCreateContext(nullptr, 1, &id_, nullptr, nullptr, &code));
    cl_check(code, "clCreateContext");
    queue_.reset(clCreateCommandQueue(context_.get(), id_, CL_QUEUE_PROFILING_ENABLE, &code));
    cl_check(code, "clCreateCommandQueue");
}

}  // namespace wavelobe
