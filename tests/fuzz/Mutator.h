// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace fuzz {

/// Makes new inputs from old ones: changes, removes, repeats and inserts bytes, makes numbers
/// extreme, inserts dictionary words and pieces of other inputs. A seed determines the sequence of
/// inputs. Not thread safe.
class Mutator {
public:
    /// \param inputs initial inputs of a run; at least one, possibly empty
    /// \param words of the format, inserted unchanged
    /// \param longest size of a new input, bytes
    /// \param seed of the random changes
    Mutator(std::vector<std::string> inputs, std::vector<std::string> words, std::size_t longest,
            std::uint64_t seed);

    /// Returns the initial inputs first, then changed ones without end.
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
