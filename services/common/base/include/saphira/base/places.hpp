#pragma once

#include <string>

namespace saphira {

/// The folder of the running program's file; our other programs are beside it.
std::string program_folder();

/// The folder of robots, worlds, maps and deployments: installed beside the program
/// (share/saphira), otherwise that of the source tree. std::runtime_error where there is neither.
std::string config_folder();

/// The folder for a user's own files: $XDG_CONFIG_HOME/saphira, or ~/.config/saphira. Empty where
/// there is no home.
std::string user_folder();

/// The folder that a file is in: "." where it is named alone.
std::string folder_of(const std::string& file);

/// The file that a person means by `name`: a path, or a file of `folder`, with or without its
/// `extension` (".wld"). std::invalid_argument that lists what there is where it is neither.
std::string find_file(const std::string& folder, const std::string& name,
                      const std::string& extension);

}  // namespace saphira
