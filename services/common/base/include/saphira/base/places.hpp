#pragma once

#include <string>
#include <vector>

namespace saphira {

/// The folder of the running program's file; the other programs are beside it.
std::string program_folder();

/// The folder of robots, worlds, maps and deployments: installed beside the program
/// (share/saphira), otherwise that of the source tree. std::runtime_error: neither exists.
std::string config_folder();

/// The folder for a user's own files: $XDG_CONFIG_HOME/saphira, or ~/.config/saphira. Empty where
/// there is no home.
std::string user_folder();

/// The folder of a file; "." for a name without a folder.
std::string folder_of(const std::string& file);

/// The names of a folder's files with that extension (".wld"), without it and sorted; none where
/// there is no such folder.
std::vector<std::string> names_in(const std::string& folder, const std::string& extension);

/// The file of that name: a path, or a file of `folder`, with or without its `extension` (".wld").
/// std::invalid_argument that lists the existing files where it is neither.
std::string find_file(const std::string& folder, const std::string& name,
                      const std::string& extension);

}  // namespace saphira
