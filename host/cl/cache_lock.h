// Keeps other processes of ours out of the kernel cache while this one compiles into it: first runs side by side race.
#pragma once

#include <string>

namespace wavelobe {

class CacheLock {
public:
    // Waits for its turn. Without a writable folder there is no cache to protect, and no lock.
    explicit CacheLock(const std::string& folder);
    ~CacheLock();
    CacheLock(const CacheLock&) = delete;
    CacheLock& operator=(const CacheLock&) = delete;

private:
    int file_ = -1;
};

}  // namespace wavelobe
