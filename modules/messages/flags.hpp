// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/option_list.hpp"

namespace planemap::messages {

/// An option by its long name without dashes (of an argument without a name: what --help calls it), and its
/// value; std::monostate where none was given and there is no default.
struct FlagValue {
    std::string name;
    std::variant<std::monostate, bool, double, std::int64_t, std::uint64_t, std::string> value;
};

/// A flag that a program adds for itself, and not from a list of options.
struct OwnFlag {
    std::string name;   ///< long, without dashes; of an argument without a name: what --help calls it
    std::string value;  ///< now, as in a --config file; empty for none
    std::string help;
};

/// A program's command line. Flags write straight into the fields they are given, show their defaults in
/// --help, and may also come from a file (--config): one `name = value` a line, # begins a comment, text may
/// stand in quotes. --dump-config prints such a file with all options as they are, and --version the
/// program's version. CLI11 does the work and stays hidden here: its header takes seconds to compile.
class Flags {
  public:
    Flags(const std::string& program, const std::string& description);
    ~Flags();
    Flags(const Flags&) = delete;
    Flags& operator=(const Flags&) = delete;

    /// A flag for each option of a module, its name led by `prefix`, under the list's heading. --help shows
    /// those for users, --help-all all of them.
    ///   flags.add(options_of(options.map), "map-");   // --map-merge-gap-m and the others
    void add(const OptionList& list, const std::string& prefix = "");

    /// A flag with a value. Short forms stand before the name: "o,output".
    void add(const std::string& name, double& field, const std::string& description);
    void add(const std::string& name, int& field, const std::string& description);
    void add(const std::string& name, std::uint64_t& field, const std::string& description);
    void add(const std::string& name, std::string& field, const std::string& description);
    void add(const std::string& name, std::filesystem::path& field, const std::string& description);
    void add(const std::string& name, std::optional<double>& field, const std::string& description);
    void add(const std::string& name, std::optional<std::uint64_t>& field, const std::string& description);
    /// A flag without a value: sets the field to true.
    void add(const std::string& name, bool& field, const std::string& description);
    /// One word of a list; the list's first is the default in --help.
    void add_choice(const std::string& name, std::string& field, const std::vector<std::string>& words,
                    const std::string& description);
    /// The last added flag must be given.
    void required();
    /// An argument without a name.
    void add_positional(const std::string& name, std::string& field, const std::string& description,
                        bool required = true);

    /// The program's name.
    std::string program() const;
    /// One or more arguments without names, at the end. They do not stand in a --config file.
    void add_positionals(const std::string& name, std::vector<std::string>& field,
                         const std::string& description);

    /// Returns -1 to go on, or the exit code: 0 after --help, --help-all, --version and --dump-config, 2 for
    /// wrong flags (said in one line on stderr; a flag that is not known with the nearest one that is).
    int parse(int argc, const char* const* argv);

    /// All options in the order they were added, with their values now.
    std::vector<FlagValue> values() const;
    /// The flags that come from no list, in the order they were added.
    std::vector<OwnFlag> own() const;

  private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace planemap::messages
