// A jump to another stack is no error here.
#undef _FORTIFY_SOURCE

#include "threads.h"

namespace spherule::instruments {

// setcontext() costs a call of the system, and longjmp() does not. So each stack is entered once by setcontext(), and
// longjmp() changes between stacks from then on.
Threads::Threads(std::byte* memory) {
    ended_.fill(true);
    for (std::uint32_t thread = 0; thread < count; ++thread) {
        ucontext_t context{};
        getcontext(&context);
        context.uc_stack.ss_sp = memory + thread * stackBytes;
        context.uc_stack.ss_size = stackBytes;
        const auto self = reinterpret_cast<std::uintptr_t>(this);
        makecontext(&context, reinterpret_cast<void (*)()>(&Threads::enter), 3, static_cast<unsigned>(self >> 32U),
                    static_cast<unsigned>(self), thread);
        start(context);
    }
}

void Threads::start(const ucontext_t& context) {
    if (_setjmp(outside_) == 0) setcontext(&context);
}

void Threads::enter(unsigned high, unsigned low, unsigned thread) {
    const std::uintptr_t self = (std::uintptr_t{high} << 32U) | low;
    reinterpret_cast<Threads*>(self)->loop(thread);
}

void Threads::loop(std::uint32_t thread) {
    for (;;) {
        leave(thread);
        body_(context_, thread);
        ended_[thread] = true;
    }
}

void Threads::leave(std::uint32_t thread) {
    if (_setjmp(inside_[thread]) == 0) _longjmp(outside_, 1);
}

void Threads::begin(void (*body)(const void*, std::uint32_t), const void* context) {
    body_ = body;
    context_ = context;
    ended_.fill(false);
}

void Threads::resume(std::uint32_t thread) {
    running_ = thread;
    if (_setjmp(outside_) == 0) _longjmp(inside_[thread], 1);
}

void Threads::wait() {
    leave(running_);
}

}  // namespace spherule::instruments
