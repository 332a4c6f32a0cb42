#pragma once

#include <map>
#include <string>

#include "net/static_file.h"

namespace spherule::host {

// The files of the page, which are embedded in the program.
class Page {
  public:
    Page();
    // Null if there is no file at `path`.
    [[nodiscard]] const net::StaticFile* find(const std::string& path) const;

  private:
    std::map<std::string, net::StaticFile> files_;  // by path
};

}  // namespace spherule::host
