// SPDX-License-Identifier: MIT
// fuzz_TARGET SECONDS FOUND [--words DICTIONARY] SEED_FILE...: a substitute for libFuzzer that runs
// a target on randomly changed files, the same ones each time. An input that ends the program, or
// takes ten seconds of the processor's time, is written to FOUND.
#include "Mutator.h"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>

#include <fcntl.h>
#include <sys/time.h>
#include <unistd.h>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

constexpr itimerval kHang{{}, {10, 0}}; ///< of processor time: a busy machine makes no input slow
constexpr itimerval kNone{};

const char* found;
const std::string* running;

/// Calls only async-signal-safe functions.
void keep(int signal) {
    const int file = ::open(found, O_CREAT | O_TRUNC | O_WRONLY, 0644);
    const bool isKept = file >= 0 && ::write(file, running->data(), running->size()) >= 0;
    const char* said =
        signal == SIGPROF ? "An input takes too long\n" : "An input ends the program\n";
    if (isKept && ::write(STDERR_FILENO, said, std::strlen(said)) < 0) ::_exit(2);
    ::_exit(1);
}

std::string contents(const char* path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// The words of a dictionary in libFuzzer's format: one quoted word per line, with \\, \" and \xAB.
std::vector<std::string> wordsOf(const char* path) {
    std::vector<std::string> words;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        const std::size_t from = line.find('"'), to = line.rfind('"');
        if (line.empty() || line[0] == '#' || from == to) continue;
        std::string word;
        for (std::size_t i = from + 1; i < to; ++i) {
            if (line[i] == '\\' && line[i + 1] == 'x') {
                word += char(std::strtol(line.substr(i + 2, 2).c_str(), nullptr, 16));
                i += 3;
            } else
                word += line[i] == '\\' ? line[++i] : line[i];
        }
        words.push_back(word);
    }
    return words;
}

} // namespace

int main(int count, char** arguments) {
    if (count < 3) {
        std::fprintf(stderr, "usage: %s SECONDS FOUND [--words DICTIONARY] SEED_FILE...\n",
                     arguments[0]);
        return 2;
    }
    found = arguments[2];
    std::vector<std::string> words, seeds;
    for (int i = 3; i < count; ++i) {
        if (!std::strcmp(arguments[i], "--words") && i + 1 < count)
            words = wordsOf(arguments[++i]);
        else
            seeds.push_back(contents(arguments[i]));
    }
    for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGPROF})
        std::signal(signal, keep);

    using Clock = std::chrono::steady_clock;
    const Clock::time_point end = Clock::now() + std::chrono::seconds(std::atoi(arguments[1]));
    fuzz::Mutator mutator(std::move(seeds), std::move(words), 65536, 1);
    long executions = 0;
    for (; Clock::now() < end; ++executions) {
        const std::string input = mutator.next();
        running = &input;
        ::setitimer(ITIMER_PROF, &kHang, nullptr);
        LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
        ::setitimer(ITIMER_PROF, &kNone, nullptr);
    }
    std::printf("%ld executions\n", executions);
    return 0;
}
