// Runs the program as users do: another process, its output and exit code.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace wavelobe::test {

// The executable that was built beside this test.
inline std::string wavelobe_executable() {
    return std::filesystem::read_symlink("/proc/self/exe").parent_path() / "wavelobe";
}

class Process {
public:
    // Standard output and error go to files in `folder`, which is also the working directory.
    Process(const std::vector<std::string>& arguments, const std::filesystem::path& folder) : folder_(folder) {
        const std::string executable = wavelobe_executable();
        std::vector<char*> pointers{const_cast<char*>(executable.c_str())};
        for (const std::string& argument : arguments) pointers.push_back(const_cast<char*>(argument.c_str()));
        pointers.push_back(nullptr);
        // What an earlier process said is not this one's.
        for (const char* name : {"stdout", "stderr"}) std::filesystem::remove(folder_ / name);
        id_ = fork();
        if (id_ != 0) return;
        // Between fork and exec only what is safe in a copy of a process with threads.
        if (chdir(folder_.c_str()) != 0) _exit(127);
        dup2(open("stdout", O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
        dup2(open("stderr", O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
        execv(executable.c_str(), pointers.data());
        _exit(127);
    }

    std::string output() const { return content("stdout"); }
    std::string errors() const { return content("stderr"); }

    // False when the process ended or `seconds` passed before the text appeared on standard error.
    bool wait_for_error_text(const std::string& text, double seconds) {
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
        while (errors().find(text) == std::string::npos) {
            if (ended() || std::chrono::steady_clock::now() > deadline) return false;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return true;
    }

    void send(int signal) const { kill(id_, signal); }

    // The exit code, or the negative number of the signal that ended it.
    int wait() {
        if (!ended_) waitpid(id_, &status_, 0);
        ended_ = true;
        return WIFEXITED(status_) ? WEXITSTATUS(status_) : -WTERMSIG(status_);
    }

private:
    bool ended() {
        if (!ended_) ended_ = waitpid(id_, &status_, WNOHANG) == id_;
        return ended_;
    }
    std::string content(const char* name) const {
        std::ostringstream text;
        text << std::ifstream(folder_ / name).rdbuf();
        return text.str();
    }

    std::filesystem::path folder_;
    pid_t id_ = 0;
    int status_ = 0;
    bool ended_ = false;
};

}  // namespace wavelobe::test
