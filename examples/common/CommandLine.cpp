// SPDX-License-Identifier: MIT
#include "CommandLine.h"

#include <osgSkin/Error>
#include <osgSkin/ExpectedNames>
#include <osgSkin/Version>

#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdio>
#include <exception>
#include <iostream>
#include <sstream>

namespace example {
namespace {

/// The help or the version, which a user asked for.
struct Information {
    std::string text;
};

/// An error message for the first empty argument; options would ignore it.
std::string findEmptyWord(int argc, const char* const* argv) {
    bool hasOptions = true; // until "--"
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word.empty())
            return std::string(i > 1 ? argv[i - 1] : "the first word") +
                   ": expected a name or number behind it, found an empty word";
        if (hasOptions && word.rfind("--", 0) == 0 && word.find('=') == word.size() - 1)
            return word + ": expected a name or number behind it, found none";
        if (word == "--") hasOptions = false;
    }
    return {};
}

/// "; did you mean \"--shapes\"?" for a misspelt option, or an empty string.
std::string suggestOption(const CLI::App& app) {
    std::vector<std::string> known;
    for (const CLI::Option* option : app.get_options())
        for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    for (const std::string& word : app.remaining()) {
        const std::string meant = osgSkin::nearestName(word.substr(0, word.find('=')), known);
        if (word.rfind("--", 0) == 0 && !meant.empty()) return "; did you mean \"" + meant + "\"?";
    }
    return {};
}

} // namespace

struct CommandLine::Parser {
    CLI::App app;
};

CommandLine::CommandLine(const std::string& program, const std::string& description,
                         const std::string& footer)
    : _program(program), _parser(new Parser{CLI::App(description, program)}) {
    CLI::App& app = _parser->app;
    // The form that help2man expects.
    app.set_version_flag("--version", program + " (osgSkin) " + osgSkin::libraryVersion());
    app.footer(footer + (footer.empty() ? "" : "\n") +
               "Exit status: 0 done, 1 failed, 2 bad usage.");
}

CommandLine::~CommandLine() = default;

CommandLine::Option CommandLine::add(const std::string& name, std::string& value,
                                     const std::string& help) {
    return Option(_parser->app.add_option(name, value, help));
}

CommandLine::Option CommandLine::add(const std::string& name, std::vector<std::string>& values,
                                     const std::string& help) {
    return Option(
        _parser->app.add_option(name, values, help)->allow_extra_args(name.rfind("--", 0) != 0));
}

CommandLine::Option CommandLine::add(const std::string& name, std::vector<std::size_t>& values,
                                     const std::string& help) {
    return Option(
        _parser->app.add_option(name, values, help)->allow_extra_args(name.rfind("--", 0) != 0));
}

CommandLine::Option CommandLine::add(const std::string& name, double& value,
                                     const std::string& help) {
    return Option(_parser->app.add_option(name, value, help));
}

CommandLine::Option CommandLine::add(const std::string& name, std::optional<double>& value,
                                     const std::string& help) {
    return Option(_parser->app.add_option(name, value, help));
}

CommandLine::Option CommandLine::add(const std::string& name, int& value, const std::string& help) {
    return Option(_parser->app.add_option(name, value, help));
}

CommandLine::Option CommandLine::add(const std::string& name, unsigned int& value,
                                     const std::string& help) {
    return Option(_parser->app.add_option(name, value, help));
}

CommandLine::Option CommandLine::add(const std::string& name, std::size_t& value,
                                     const std::string& help) {
    return Option(_parser->app.add_option(name, value, help));
}

CommandLine::Option CommandLine::add(const std::string& name, bool& value,
                                     const std::string& help) {
    return Option(_parser->app.add_flag(name, value, help));
}

CommandLine::Option CommandLine::add(const std::string& name,
                                     const std::function<void(const std::string&)>& set,
                                     const std::string& help) {
    const auto checked = [set](const std::string& value) {
        try {
            set(value);
        } catch (const std::exception& error) {
            throw CLI::ValidationError(error.what());
        }
    };
    return Option(_parser->app.add_option_function<std::string>(name, checked, help));
}

void CommandLine::parse(int argc, const char* const* argv) {
    CLI::App& app = _parser->app;
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        throw Information{app.help()};
    } catch (const CLI::CallForVersion& version) {
        throw Information{version.what() + std::string("\n")};
    } catch (const CLI::ParseError& error) {
        throw UsageError(error.what() + suggestOption(app));
    }
}

int CommandLine::run(int argc, const char* const* argv, const std::function<int()>& body) {
    int status = 0;
    try {
        const std::string wrong = findEmptyWord(argc, argv);
        if (!wrong.empty()) throw UsageError(wrong);
        status = body();
    } catch (const Information& information) {
        std::cout << information.text;
    } catch (const UsageError& error) {
        std::cerr << _program << ": " << osgSkin::onOneLine(error.what()) << "\nTry " << _program
                  << " --help." << std::endl;
        status = 2;
    } catch (const std::exception& error) {
        std::cerr << _program << ": " << error.what() << std::endl;
        status = 1;
    }
    std::cout.flush(); // fails if the disk is full
    if (std::cout && std::fflush(stdout) == 0 && !std::ferror(stdout)) return status;
    std::cerr << _program << ": standard output cannot be written" << std::endl;
    return status == 0 ? 1 : status;
}

CommandLine::Option& CommandLine::Option::required() {
    _option->required();
    return *this;
}

CommandLine::Option& CommandLine::Option::needs(const Option& other) {
    _option->needs(other._option);
    return *this;
}

CommandLine::Option& CommandLine::Option::excludes(const Option& other) {
    _option->excludes(other._option);
    return *this;
}

CommandLine::Option& CommandLine::Option::range(double least, double most) {
    std::ostringstream range;
    range.precision(9);
    range << "a number from " << least << " to " << most;
    _option->check([=, text = range.str()](const std::string& word) {
        double value = 0.0;
        const bool isInside =
            CLI::detail::lexical_cast(word, value) && least <= value && value <= most; // no NaN
        return isInside ? std::string() : "expected " + text + ", found \"" + word + '"';
    });
    return *this;
}

CommandLine::Option& CommandLine::Option::oneOf(const std::vector<std::string>& values) {
    _option->check(CLI::IsMember(values));
    return *this;
}

CommandLine::Option& CommandLine::Option::showDefault() {
    _option->capture_default_str();
    return *this;
}

CommandLine::Option& CommandLine::Option::valueOptional() {
    _option->expected(0, 1);
    return *this;
}

CommandLine::Option& CommandLine::Option::describe(const std::string& type,
                                                   const std::string& group) {
    _option->type_name(type)->group(group);
    return *this;
}

bool CommandLine::Option::isGiven() const {
    return _option->count() > 0;
}

} // namespace example
