// A page printed by Chromium, which lays it out as a reader's browser does.
#pragma once

#include <filesystem>
#include <string>

namespace scan2fea::command {

// Chromium or Chrome, as the PATH has it. Throws IoError where there is none, before any work is done.
std::filesystem::path require_chromium();

// The page as a PDF, in about 3 s. Throws IoError where Chromium fails, or takes longer than a minute.
std::string printed_as_pdf(const std::string& page);

}  // namespace scan2fea::command
