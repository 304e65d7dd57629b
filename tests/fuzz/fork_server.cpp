// Preloaded into the command, it stops before main() and runs it again and again, each time in a
// copy of the process: the dynamic linker, which takes ten times as long as most refusals, works
// once.
//
// A request on standard input: its length (32 bits), then words that each end in a zero byte: the
// file for both outputs, then the arguments. Answers on standard output, 64 bits each: the pid when
// it has begun; its wait status and the most KB that it held when it has ended.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

namespace {

using Main = int (*)(int, char**, char**);
Main command;

bool read_all(void* bytes, std::size_t count) {
  for (char* at = static_cast<char*>(bytes); count > 0;) {
    const ssize_t got = read(STDIN_FILENO, at, count);
    if (got <= 0) return false;
    at += got;
    count -= static_cast<std::size_t>(got);
  }
  return true;
}

void answer(std::int64_t number) {
  if (write(STDOUT_FILENO, &number, sizeof number) != sizeof number) std::exit(1);
}

int run_command(std::string& request, char* name, char** environment) {
  const char* output = request.c_str();
  std::vector<char*> arguments{name};
  for (std::size_t at = request.find('\0') + 1; at < request.size();
       at = request.find('\0', at) + 1)
    arguments.push_back(&request[at]);
  arguments.push_back(nullptr);
  const int nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
  const int file = open(output, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (nothing < 0 || file < 0 || dup2(nothing, STDIN_FILENO) < 0 || dup2(file, STDOUT_FILENO) < 0 ||
      dup2(file, STDERR_FILENO) < 0)
    return 126;
  return command(static_cast<int>(arguments.size()) - 1, arguments.data(), environment);
}

int serve(int, char** arguments, char** environment) {
  unsetenv("LD_PRELOAD");  // a linker that PoCL starts is to link
  for (std::uint32_t length = 0; read_all(&length, sizeof length);) {
    std::string request(length, '\0');
    if (!read_all(request.data(), length)) return 1;
    const pid_t child = fork();
    if (child < 0) return 1;
    if (child == 0) return run_command(request, arguments[0], environment);
    answer(child);
    int status = 0;
    rusage used{};
    if (wait4(child, &status, 0, &used) != child) return 1;
    answer(status);
    answer(used.ru_maxrss);
  }
  return 0;
}

}  // namespace

// What a program's first instructions call. NOLINTNEXTLINE(bugprone-reserved-identifier)
extern "C" int __libc_start_main(Main main, int count, char** arguments, void (*init)(),
                                 void (*fini)(), void (*linker_fini)(), void* stack_end) {
  command = main;
  const auto start =
      reinterpret_cast<decltype(&__libc_start_main)>(dlsym(RTLD_NEXT, "__libc_start_main"));
  return start(serve, count, arguments, init, fini, linker_fini, stack_end);
}
