#include "python/vdbsynth/call.h"

#include "libvdbsynth/base/error.h"

#include <pybind11/gil.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <new>
#include <thread>
#include <variant>

namespace vdbsynth::python {
namespace {

constexpr auto kPollInterval = std::chrono::milliseconds(50);

using Message = std::pair<MessageLevel, std::string>;
using Event = std::variant<Progress, Message>;

// What the working thread and the calling one share.
struct Shared {
    std::mutex mutex;
    std::condition_variable changed;
    std::vector<Event> events;
    bool done = false;
    std::exception_ptr failure;
    std::atomic<bool> stop{false};

    void push(Event event) {
        {
            const std::lock_guard<std::mutex> lock(mutex);
            // A slow listener hears the newest state of a stage, not all of them.
            const Progress* last = events.empty() ? nullptr : std::get_if<Progress>(&events.back());
            const Progress* next = std::get_if<Progress>(&event);
            if (last && next && last->stage == next->stage)
                events.back() = std::move(event);
            else
                events.push_back(std::move(event));
        }
        changed.notify_one();
    }
    // All that is new. @return false once the work is done
    bool wait(std::vector<Event>& fresh) {
        std::unique_lock<std::mutex> lock(mutex);
        changed.wait_for(lock, kPollInterval, [&] { return done || !events.empty(); });
        fresh.swap(events);
        return !done;
    }
};

const char* wordOf(MessageLevel level) {
    return level == MessageLevel::Warning ? "warning" : level == MessageLevel::Note ? "note" : "detail";
}

// Nothing that is lost or guessed passes in silence: without a listener it goes to Python's logging, which
// prints warnings unless it is told otherwise.
void logMessage(const Message& said) {
    const char* method = said.first == MessageLevel::Warning ? "warning"
                         : said.first == MessageLevel::Note  ? "info"
                                                             : "debug";
    py::module_::import("logging").attr("getLogger")("vdbsynth").attr(method)("%s", said.second);
}

void deliver(const Call& call, const Event& event) {
    if (const Progress* progress = std::get_if<Progress>(&event)) {
        if (!call.onProgress.is_none()) call.onProgress(progress->stage, progress->done, progress->total);
        return;
    }
    const Message& said = std::get<Message>(event);
    if (call.onMessage.is_none())
        logMessage(said);
    else
        call.onMessage(wordOf(said.first), said.second);
}

bool isCancelled(const Call& call) {
    return !call.cancel.is_none() && py::cast<bool>(py::bool_(call.cancel.attr("is_set")()));
}

// The calling thread's part of one round; what it raises is kept, and stops the work.
void attend(const Call& call, const std::vector<Event>& events, Shared& shared, std::exception_ptr& raised) {
    if (raised) return;
    try {
        for (const Event& event : events) deliver(call, event);
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        if (isCancelled(call)) shared.stop = true;
    } catch (...) {
        raised = std::current_exception();
        shared.stop = true;
    }
}

// The codes of what is no Error are those of the command line.
void work(const std::function<void(const RunContext&)>& todo, const RunContext& context, Shared& shared) {
    std::exception_ptr failure;
    try {
        todo(context);
    } catch (const Error&) {
        failure = std::current_exception();
    } catch (const std::bad_alloc&) {
        failure = std::make_exception_ptr(Error(
            ErrorCode::Memory, "out of memory; use larger voxels, a smaller size or a larger `maxMemory`"));
    } catch (const std::exception& error) {
        failure =
            std::make_exception_ptr(Error(ErrorCode::Solver, std::string("internal error: ") + error.what()));
    } catch (...) {
        failure = std::make_exception_ptr(Error(ErrorCode::Solver, "internal error"));
    }
    {
        const std::lock_guard<std::mutex> lock(shared.mutex);
        shared.failure = failure;
        shared.done = true;
    }
    shared.changed.notify_one();
}

}  // namespace

void Call::execute(const std::function<void(const RunContext&)>& todo) {
    Shared shared;
    RunContext own = context;
    own.cancel = &shared.stop;
    own.onProgress = [&](const Progress& progress) { shared.push(progress); };
    own.onMessage = [&](MessageLevel level, const std::string& text) { shared.push(Message{level, text}); };
    std::exception_ptr raised;
    // Work that is quicker than the first look would not hear of it.
    shared.stop = isCancelled(*this);
    throwIfCancelled(own);
    std::thread worker([&] { work(todo, own, shared); });
    for (bool running = true; running;) {
        std::vector<Event> events;
        {
            const py::gil_scoped_release released;
            running = shared.wait(events);
        }
        attend(*this, events, shared, raised);
    }
    {
        const py::gil_scoped_release released;
        worker.join();
    }
    if (raised) std::rethrow_exception(raised);
    if (shared.failure) std::rethrow_exception(shared.failure);
}

}  // namespace vdbsynth::python
