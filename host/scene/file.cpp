// Whole files in memory.
#include "scene/file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "scene/fault.h"

namespace wavelobe {

std::string read_file(const std::string& path) {
    const auto refuse = [&](const std::string& message) {
        throw InputError(Fault{path, 0, 0, "", message, "check the path and the permissions"});
    };
    std::error_code error;
    const auto size = std::filesystem::file_size(path, error);
    if (error) refuse("cannot read the file: " + error.message());
    std::ifstream stream(path, std::ios::binary);
    if (!stream) refuse(std::string("cannot open the file: ") + std::strerror(errno));
    std::string content(size, '\0');
    stream.read(content.data(), static_cast<std::streamsize>(size));
    if (static_cast<std::uintmax_t>(stream.gcount()) != size) refuse("the file ended before its size was reached");
    return content;
}

void require_file(const std::string& path) {
    std::error_code error;
    [[maybe_unused]] const auto size = std::filesystem::file_size(path, error);
    if (error) throw InputError(Fault{path, 0, 0, "", "cannot read the file: " + error.message(), "check the path and the permissions"});
}

}  // namespace wavelobe
