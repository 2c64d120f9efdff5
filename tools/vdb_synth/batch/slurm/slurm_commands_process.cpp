// Runs one command to its end.
#include "tools/vdb_synth/batch/slurm/slurm_commands.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;

namespace vdbsynth::cli::batch {
namespace {

// Users set their own columns and filters for squeue and sacct by variables, which would hide tasks.
std::vector<char*> plainEnvironment() {
    std::vector<char*> variables;
    for (char** variable = environ; *variable; ++variable)
        if (std::strncmp(*variable, "SQUEUE_", 7) != 0 && std::strncmp(*variable, "SACCT_", 6) != 0)
            variables.push_back(*variable);
    variables.push_back(nullptr);
    return variables;
}

struct Pipe {
    int ends[2] = {-1, -1};
    Pipe() {
        if (::pipe2(ends, O_CLOEXEC) != 0) ends[0] = ends[1] = -1;
    }
    ~Pipe() {
        close(0);
        close(1);
    }
    void close(int end) {
        if (ends[end] >= 0) ::close(ends[end]);
        ends[end] = -1;
    }
};

pid_t spawned(const std::vector<std::string>& words, Pipe& input, Pipe& output, Pipe& errors) {
    std::vector<char*> argv;
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, input.ends[0], 0);
    ::posix_spawn_file_actions_adddup2(&actions, output.ends[1], 1);
    ::posix_spawn_file_actions_adddup2(&actions, errors.ends[1], 2);
    ::posix_spawnattr_init(&attributes);
    ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    pid_t process = -1;
    std::vector<char*> environment = plainEnvironment();
    if (::posix_spawnp(&process, argv[0], &actions, &attributes, argv.data(), environment.data()) != 0)
        process = -1;
    ::posix_spawnattr_destroy(&attributes);
    ::posix_spawn_file_actions_destroy(&actions);
    return process;
}

// False at the end of the stream.
bool readSome(int file, std::string& text) {
    char buffer[65536];
    const ssize_t got = ::read(file, buffer, sizeof buffer);
    if (got > 0) text.append(buffer, std::size_t(got));
    return got > 0;
}

}  // namespace

CommandOutput runCommand(const std::vector<std::string>& words, const std::string& input, double seconds) {
    CommandOutput result;
    Pipe in, out, errors;
    const pid_t process = spawned(words, in, out, errors);
    if (process < 0) {
        result.code = 127;
        return result;
    }
    in.close(0);
    out.close(1);
    errors.close(1);
    const ssize_t ignored = ::write(in.ends[1], input.data(), input.size());
    (void)ignored;
    in.close(1);
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    bool late = false;
    while (out.ends[0] >= 0 || errors.ends[0] >= 0) {
        pollfd files[2] = {{out.ends[0], POLLIN, 0}, {errors.ends[0], POLLIN, 0}};
        ::poll(files, 2, 200);
        if (files[0].revents && !readSome(out.ends[0], result.text)) out.close(0);
        if (files[1].revents && !readSome(errors.ends[0], result.errors)) errors.close(0);
        late = std::chrono::steady_clock::now() > end;
        if (late) break;
    }
    if (late) ::kill(-process, SIGKILL);
    int status = 0;
    while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    result.code = late ? -1 : WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    return result;
}

}  // namespace vdbsynth::cli::batch
