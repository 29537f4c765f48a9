// One function per command of the program. Each returns the exit code of core/error.hpp and throws
// Error.
#pragma once
#include <run/options.hpp>
#include <string>
#include <vector>

namespace whirl::app {

struct CheckOptions {
  std::filesystem::path deck;
  deck::ReadOptions read;
  bool json = false, quiet = false, resolved = false;
  double max_memory = 0, max_disk = 0;  ///< as in run::RunOptions
  std::filesystem::path
      mesh;  ///< folder for the mesh as tables and the drawing of the rotor; empty: none
};
/// Reads a deck and prints what is wrong with it; station table, masses and summary of a good one.
int check_deck(const CheckOptions& options);

struct RunCommand {
  std::filesystem::path deck;
  deck::ReadOptions read;
  run::RunOptions run;
};
int run_command(const RunCommand& options);

enum class SchemaForm { json, reference, units };
/// JSON schema of decks, the reference of all tables and keys, or the table of units (Markdown).
int print_schema(SchemaForm form);
/// The same as --reference, page by page: deck.md and the folder deck.
/// @throws Error (Exit::io) when they cannot be written.
int write_reference(const std::filesystem::path& folder);
std::string json_schema();

/// The long text of each code, or the list of all codes.
/// @throws Error (Exit::usage) for a code there is not.
int explain(const std::vector<std::string>& codes);

struct NewOptions {
  std::string example;               ///< name of one
  std::string machine;               ///< of a starter; neither: list both
  std::vector<std::string> answers;  ///< "key=value", to the questions of the starter
  bool questions = false;            ///< print those instead
  std::filesystem::path file;        ///< empty: standard output
  bool force = false;
};
/// Writes a commented deck to start from.
/// @throws Error (E91, Exit::usage) for an example or a machine there is not, or a file that is there
/// already; of a starter also (Exit::deck) with what is wrong with the deck that the answers make.
int new_deck(const NewOptions& options);

struct ConvertOptions {
  std::filesystem::path input;
  std::filesystem::path output;  ///< empty: standard output
  std::string sheet;             ///< of a workbook; empty: the first with cells
  bool force = false;
};
/// A file of another program as a deck (or a table of one), and what of it was left out. The deck
/// is read at once: what is wrong with it is printed too.
/// @throws Error (E42, E02, E03, E91) when nothing can be made of it or written.
int convert_model(const ConvertOptions& options);

struct ViewOptions {
  std::filesystem::path results;
  std::string set;               ///< step or shape; empty: that of most frames
  std::filesystem::path script;  ///< empty: view.py in the results folder
  bool open = false;             ///< start ParaView with it
};
/// A state script of ParaView that opens the frames of a results folder, arranged.
/// @throws Error (E43) without frames, of that name or any, or without a ParaView to start; (E91).
int view_results(const ViewOptions& options);

/// One command as the shell completion needs it.
struct CommandInfo {
  std::string name;
  std::vector<std::string> options;
  bool takes_deck = false;
};
/// Completion script for bash (also zsh through bashcompinit); "fish" has its own.
std::string completion_script(const std::string& shell, const std::vector<CommandInfo>& commands);

}  // namespace whirl::app
