#pragma once

namespace spherule::cli {

// Handles SIGINT, SIGTERM and SIGHUP in a command that works on files. At first, a signal ends the program at once.
// After finishFirst(), the first signal asks the command to finish, and a second SIGINT or SIGTERM ends the program at
// once. The exit code is then exitBySignal plus the signal's number, also for the first process of a container. A
// signal that was ignored before stays ignored. At most one Interrupt may exist at a time.
class Interrupt {
  public:
    Interrupt();
    ~Interrupt();  // restores the previous handlers
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    void finishFirst();
    [[nodiscard]] bool asked() const { return signal() != 0; }
    [[nodiscard]] int signal() const;  // the signal that asked the command to finish; 0: none
    [[nodiscard]] const char* name() const;
};

}  // namespace spherule::cli
