// How the command ends before its work is done: by an interrupt, or when its time is over.
//
// At once, from a signal handler, whatever it is at: there is nothing to unwind. Outputs have no names before they are
// whole, or noted ones (output_file.hpp), and TetGen's worker ends with the process that started it.
#pragma once

#include <chrono>
#include <string>

namespace scan2fea::command {

// To be called by the main thread. From here on SIGINT, SIGTERM and SIGHUP end the process with exit code 130, an input
// that another program shortens while it is read (input_file.hpp) ends it with 3, and what would end it without a code
// (a pipe that nobody reads, a limit on the size of files) is an error of the write instead.
void end_on_interrupts();

// After so much time from now the process ends with exit code 4 and this error on stderr.
void end_after(std::chrono::duration<double> time, const std::string& text);

// All that was to be written is in place: from here on nothing of the above ends the process.
void ends_by_itself_now();

}  // namespace scan2fea::command
