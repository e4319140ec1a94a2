#include "film/replace_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "scene/fault.h"

namespace wavelobe {
namespace {

namespace fs = std::filesystem;

// Two processes writing the same picture must not share it.
fs::path temporary_name(const fs::path& target) {
    return target.parent_path() / ("." + target.filename().string() + "." + std::to_string(getpid()) + ".tmp");
}

// An open file that is removed again unless it was renamed to its target.
class TemporaryFile {
public:
    explicit TemporaryFile(const fs::path& target)
        : target_(target),
          path_(temporary_name(target)),
          descriptor_(open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {}
    ~TemporaryFile() {
        const bool created = descriptor_ >= 0 || closed_;
        if (descriptor_ >= 0) close(descriptor_);
        if (created && !renamed_) unlink(path_.c_str());
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    bool is_open() const { return descriptor_ >= 0; }

    bool write_all(std::string_view bytes) {
        while (!bytes.empty()) {
            const ssize_t count = write(descriptor_, bytes.data(), bytes.size());
            if (count < 0 && errno == EINTR) continue;
            if (count < 0) return false;
            bytes.remove_prefix(static_cast<std::size_t>(count));
        }
        return true;
    }

    // Network file systems report a full disk only at closing.
    bool move_to_target() {
        closed_ = true;
        const int descriptor = descriptor_;
        descriptor_ = -1;
        if (close(descriptor) != 0) return false;
        renamed_ = std::rename(path_.c_str(), target_.c_str()) == 0;
        return renamed_;
    }

private:
    fs::path target_;
    fs::path path_;
    int descriptor_;
    bool closed_ = false;
    bool renamed_ = false;
};

}  // namespace

fs::path output_target(const std::string& path) {
    std::error_code error;
    // A relative path none of which exists would be left relative.
    const fs::path absolute = fs::absolute(path, error);
    const fs::path target = fs::weakly_canonical(absolute, error);
    return error ? absolute : target;
}

void refuse_unwritable(const std::string& path) {
    const auto refuse = [&](const std::string& message, const std::string& hint) {
        throw InputError(Fault{path, 0, 0, "", message, hint});
    };
    if (path.empty()) refuse("the output file has no name", "");
    const fs::path target = output_target(path);
    const fs::path folder = target.parent_path();
    std::error_code error;
    const fs::file_status status = fs::status(target, error);
    if (fs::is_directory(status) || !target.has_filename()) refuse("is a folder", "name a file in it");
    if (fs::exists(status) && !fs::is_regular_file(status)) refuse("is not a regular file", "name another one");
    if (!fs::is_directory(folder, error)) {
        refuse("cannot be written: there is no folder " + folder.string(), "create it first");
    }
    if (fs::exists(status) && access(target.c_str(), W_OK) != 0) {
        refuse(std::string("cannot be written: ") + std::strerror(errno), "name another file or change its permissions");
    }
    const TemporaryFile trial(target);
    if (!trial.is_open()) {
        refuse(std::string("cannot be written: ") + std::strerror(errno), "name another folder or change its permissions");
    }
}

void replace_file(const std::string& path, std::string_view bytes) {
    TemporaryFile file(output_target(path));
    if (!file.is_open() || !file.write_all(bytes) || !file.move_to_target()) {
        throw std::runtime_error("cannot write " + path + ": " + std::strerror(errno));
    }
}

}  // namespace wavelobe
