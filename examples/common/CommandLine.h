// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace CLI {
class Option;
}

namespace example {

/// The CHARACTER argument of every program.
constexpr char kCharacterHelp[] =
    "a .skin file, a rigged model (model.glb, model.fbx.skin, ...) or a saved character (.osgb)";

/// Bad usage: a program prints the message and exits with 2.
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The arguments of a program, with its `--help` and `--version`.
///
/// CLI11 parses them. CommandLine.cpp alone includes it: its headers take seconds to compile.
class CommandLine {
public:
    /// An argument; its methods restrict it.
    class Option {
    public:
        Option& required();
        Option& needs(const Option& other);
        Option& excludes(const Option& other);
        /// A finite number.
        Option& range(double least, double most);
        Option& oneOf(const std::vector<std::string>& values);
        /// The help shows the value that the variable has now.
        Option& showDefault();
        /// At most one value, or none behind the name.
        Option& valueOptional();
        /// The help shows this in place of the type, and lists the option under `group`; options of
        /// the group "" are not listed.
        Option& describe(const std::string& type, const std::string& group);
        bool isGiven() const;

    private:
        friend class CommandLine;
        explicit Option(CLI::Option* option) : _option(option) {}
        CLI::Option* _option;
    };

    /// \param program the name for messages
    /// \param description one sentence
    /// \param footer the end of the help; the exit statuses are added
    CommandLine(const std::string& program, const std::string& description,
                const std::string& footer = {});
    ~CommandLine();
    CommandLine(const CommandLine&) = delete;
    CommandLine& operator=(const CommandLine&) = delete;

    /// Adds an argument: an option if its name begins with "--", otherwise a positional one.
    ///
    /// \param value set by parse(); must outlive it. A vector takes any number of values: a
    ///   positional argument several in a row, an option one each time it is given.
    Option add(const std::string& name, std::string& value, const std::string& help = {});
    Option add(const std::string& name, std::vector<std::string>& values,
               const std::string& help = {});
    Option add(const std::string& name, std::vector<std::size_t>& values,
               const std::string& help = {});
    Option add(const std::string& name, double& value, const std::string& help = {});
    Option add(const std::string& name, std::optional<double>& value, const std::string& help = {});
    Option add(const std::string& name, int& value, const std::string& help = {});
    Option add(const std::string& name, unsigned int& value, const std::string& help = {});
    Option add(const std::string& name, std::size_t& value, const std::string& help = {});
    /// An option without a value.
    Option add(const std::string& name, bool& value, const std::string& help = {});
    /// Calls `set` with the value; what it throws is bad usage.
    Option add(const std::string& name, const std::function<void(const std::string&)>& set,
               const std::string& help = {});

    /// Reads the arguments. Does not return if the help or the version was asked for: run() prints
    /// these and exits with 0.
    /// \throw UsageError with a suggestion for a misspelt option
    void parse(int argc, const char* const* argv);

    /// Calls `body`, which calls parse(), and prints what it throws.
    ///
    /// \param argc, argv refused if one is empty, for example from an unset shell variable
    /// \return the exit status: that of `body`, 2 for a UsageError, 1 for other exceptions, or if
    ///   standard output cannot be written
    int run(int argc, const char* const* argv, const std::function<int()>& body);

private:
    struct Parser;
    std::string _program;
    std::unique_ptr<Parser> _parser;
};

} // namespace example
