#include "cl/cache_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace wavelobe {

CacheLock::CacheLock(const std::string& folder) : file_(open((folder + "/lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644)) {
    if (file_ >= 0) flock(file_, LOCK_EX);
}

CacheLock::~CacheLock() {
    if (file_ >= 0) close(file_);  // releases the lock
}

}  // namespace wavelobe
