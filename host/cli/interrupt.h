// Ctrl-C and SIGTERM as a wish to stop, not as an end.
#pragma once

namespace wavelobe {

// From now on the first of these signals only sets the flag; the second ends the process at once.
void catch_interrupts();
bool interrupted();

}  // namespace wavelobe
