#pragma once

namespace spherule::app {

// What SIGINT, SIGTERM and SIGHUP do to a command that works on files. At first, one ends the program at once. After
// finishFirst(), the first one asks the command to come to its end, and a second SIGINT or SIGTERM ends the program at
// once. The exit code is then exitBySignal plus the signal's number, also for the first process of a container. A
// signal that was ignored before stays so. There is at most one at a time.
class Interrupt {
  public:
    Interrupt();
    ~Interrupt();  // signals do what they did before
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    void finishFirst();
    [[nodiscard]] bool asked() const { return signal() != 0; }
    [[nodiscard]] int signal() const;  // which one asked; 0: none
    [[nodiscard]] const char* name() const;
};

}  // namespace spherule::app
