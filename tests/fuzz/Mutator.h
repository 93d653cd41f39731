// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace fuzz {

/// Makes inputs of others: bytes changed, taken out, doubled and put in, numbers made extreme,
/// words of a dictionary, pieces of other inputs. One seed gives one sequence of inputs. Not thread
/// safe.
class Mutator {
public:
    /// \param inputs what a run starts from; at least one, and an empty one will do
    /// \param words of the format, put in as they are
    /// \param longest of the inputs made, in bytes
    Mutator(std::vector<std::string> inputs, std::vector<std::string> words, std::size_t longest,
            std::uint64_t seed);

    /// The inputs themselves first, then changed ones without end.
    std::string next();

private:
    std::size_t below(std::size_t count) { return count > 0 ? _random() % count : 0; }
    const std::string& any(const std::vector<std::string>& of) { return of[below(of.size())]; }
    void change(std::string& input);
    void changeByte(std::string& input);
    void changeNumber(std::string& input);
    void putIn(std::string& input, const std::string& what);
    std::string piece(const std::string& of);

    std::vector<std::string> _inputs, _words;
    std::size_t _longest, _given = 0;
    std::mt19937_64 _random;
};

} // namespace fuzz
