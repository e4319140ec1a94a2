#include "cl/buffer.h"

#include <sys/mman.h>

#include <algorithm>
#include <cstdlib>

namespace wavelobe {
namespace {

constexpr std::size_t huge_page = std::size_t{2} << 20U;
constexpr std::size_t cache_line = 64;

}  // namespace

void Buffer::Free::operator()(std::byte* pointer) const { std::free(pointer); }

Buffer::Buffer(const Device& device, std::size_t bytes) : bytes_(bytes) {
    if (bytes > device.info().max_allocation_bytes) {
        throw ClError("a buffer of " + std::to_string(bytes >> 20U) + " MiB exceeds the largest the device allows, " +
                      std::to_string(device.info().max_allocation_bytes >> 20U) +
                      " MiB; reduce the meshes or textures of the scene");
    }
    // Vector loads at the end of a queue or table may read past it by less than two lines.
    const std::size_t padded = bytes + 2 * cache_line;
    const std::size_t alignment = padded >= huge_page ? huge_page : 4096;
    const std::size_t size = (padded + alignment - 1) / alignment * alignment;
    host_.reset(static_cast<std::byte*>(std::aligned_alloc(alignment, size)));
    if (!host_) throw ClError("out of memory: " + std::to_string(size >> 20U) + " MiB could not be allocated");
    if (alignment == huge_page) madvise(host_.get(), size, MADV_HUGEPAGE);
    std::memset(host_.get(), 0, size);
    cl_int code = CL_SUCCESS;
    memory_.reset(
        clCreateBuffer(device.context(), CL_MEM_READ_WRITE | CL_MEM_USE_HOST_PTR, size, host_.get(), &code));
    cl_check(code, "clCreateBuffer");
}

}  // namespace wavelobe
