#include "cli/interrupt.h"

#include <signal.h>
#include <unistd.h>

namespace wavelobe {
namespace {

volatile sig_atomic_t interrupt_flag = 0;

void note_interrupt(int) {
    interrupt_flag = 1;
    constexpr char message[] = "\nstopping after this wave; once more to quit at once\n";
    // Nothing can be done about a terminal that has gone.
    [[maybe_unused]] const ssize_t ignored = write(STDERR_FILENO, message, sizeof message - 1);
}

}  // namespace

void catch_interrupts() {
    struct sigaction action {};
    action.sa_handler = note_interrupt;
    action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() { return interrupt_flag != 0; }

}  // namespace wavelobe
