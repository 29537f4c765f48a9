// Decks to start from, one a kind of machine: texts with questions, which answers turn into a deck.
//
// A starter is a deck whose first lines ask ("#? key = default : what is asked"). The default tells
// the kind: a quantity in quotes, which becomes a parameter of the deck; words with " | " between
// them, of which one is chosen; "5 (1..9)", a number in these limits. In the deck
//   #if key = word ... #end     stays where that word was chosen,
//   #each key ... #end          stands as often as the number says, {k} counting from 1.
// Everything else is the deck.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace whirl::app {

struct Question {
  enum class Kind { quantity, choice, number };
  std::string key, text;
  std::string answer;  ///< the default
  Kind kind = Kind::quantity;
  std::vector<std::string> words{};  ///< of a choice
  int least = 0, most = 0;           ///< of a number
};

struct Starter {
  std::string machine;  ///< "pump"
  std::string text;     ///< after the questions
  std::vector<Question> questions;
};

/// By name of the machine.
/// @throws std::logic_error for a text that is not as above: a mistake of the program.
const std::vector<Starter>& starters();
/// The deck with these answers; a question that is not answered takes its default.
/// @throws Error (Exit::usage) for an answer to no question, a word or number that cannot be.
std::string starter_deck(const Starter& starter,
                         const std::vector<std::pair<std::string, std::string>>& answers);

}  // namespace whirl::app
