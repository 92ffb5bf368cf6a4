#include "daemon/ctl/recipe_commands.hpp"

#include <cstdlib>
#include <filesystem>

#include <CLI/CLI.hpp>

#include "config/strict_json.hpp"
#include "core/base/error.hpp"
#include "daemon/ctl/exit_codes.hpp"
#include "daemon/ctl/readable_range.hpp"
#include "daemon/recipes/recipe_document.hpp"

namespace fvd::ctl {

namespace {

void print(std::ostream& out, const Json& json) {
  out << json.dump(2, ' ', false, Json::error_handler_t::replace) << std::endl;
}

/// The document's id where none is named: the file's name without its suffix.
std::string id_of(const RecipeArguments& arguments) {
  return arguments.id.empty() ? std::filesystem::path(arguments.file).stem().string() : arguments.id;
}

int list(RpcClient client, const Terminal& terminal) {
  const Json reply = client.call("recipe.list");
  for (const Json& entry : reply.at("entries")) {
    terminal.out << entry.at("id").get<std::string>() << "  ";
    // Version 0 of an edited one: its file cannot be read.
    if (entry.value("edited", entry.at("version") != 0)) {
      terminal.out << "version " << entry.at("version");
    } else {
      terminal.out << "shipped";
    }
    const auto error = entry.find("error_message");
    terminal.out << (error == entry.end() ? "" : "  " + error->get<std::string>()) << "\n";
  }
  terminal.out << std::flush;
  return kExitOk;
}

int get(const RecipeArguments& arguments, RpcClient client, const Terminal& terminal) {
  const Json reply = client.call("recipe.get", {{"id", arguments.id}});
  terminal.out << reply.at("text").get<std::string>() << std::flush;
  terminal.err << "fvdctl: version " << reply.at("version") << std::endl;
  return kExitOk;
}

int check(const RecipeArguments& arguments, RpcClient client, const Terminal& terminal) {
  const Json reply = client.call("recipe.check", {{"id", id_of(arguments)}, {"text", read_text_file(arguments.file)}});
  for (const Json& note : reply.at("notes")) terminal.err << "fvdctl: note: " << note.get<std::string>() << "\n";
  if (reply.at("accepted").get<bool>()) {
    terminal.out << arguments.file << ": accepted, sha256 " << reply.at("sha256").get<std::string>() << std::endl;
    return kExitOk;
  }
  terminal.err << reply.at("refusal").get<std::string>() << std::endl;
  return kExitBadData;
}

std::string author_of(const RecipeArguments& arguments) {
  if (!arguments.author.empty()) return arguments.author;
  const char* user = std::getenv("USER");
  return user != nullptr && *user != '\0' ? user : "fvdctl";
}

/// The reply to out. A new version has another number than its base: the same number is the text in force.
int report_saved(const Json& reply, std::int64_t base_version, const Terminal& terminal) {
  print(terminal.out, reply);
  terminal.err << "fvdctl: recipe " << reply.at("id").get<std::string>() << ": ";
  if (reply.at("version") == base_version) {
    terminal.err << "nothing changed, version " << base_version << " with this text is in force already" << std::endl;
  } else {
    terminal.err << "version " << reply.at("version") << " is in force now" << std::endl;
  }
  return kExitOk;
}

int save(const RecipeArguments& arguments, RpcClient client, const Terminal& terminal) {
  const std::string id = id_of(arguments);
  const std::string text = read_text_file(arguments.file);
  const Json reply = client.call("recipe.save", {{"id", id},
                                                 {"text", text},
                                                 {"base_version", arguments.base_version},
                                                 {"author", author_of(arguments)},
                                                 {"comment", arguments.comment}});
  return report_saved(reply, arguments.base_version, terminal);
}

int versions(const RecipeArguments& arguments, RpcClient client, const Terminal& terminal) {
  const Json reply = client.call("recipe.versions", {{"id", arguments.id}});
  for (const Json& version : reply.at("versions")) {
    terminal.out << version.at("version") << "  " << version.at("saved").get<std::string>() << "  "
                 << version.at("author").get<std::string>() << "  " << version.at("comment").get<std::string>() << "\n";
  }
  terminal.out << std::flush;
  return kExitOk;
}

int restore(const RecipeArguments& arguments, RpcClient client, const Terminal& terminal) {
  const Json reply = client.call("recipe.restore", {{"id", arguments.id},
                                                    {"version", arguments.version},
                                                    {"base_version", arguments.base_version},
                                                    {"author", author_of(arguments)}});
  return report_saved(reply, arguments.base_version, terminal);
}

int convert(const RecipeArguments& arguments, const Terminal& terminal) {
  const std::string text = read_text_file(arguments.file);
  terminal.out << convert_recipe(text, id_of(arguments)) << std::flush;
  if (text.find("//") != std::string::npos || text.find("/*") != std::string::npos) {
    terminal.err << "fvdctl: note: comments are not carried over" << std::endl;
  }
  return kExitOk;
}

}  // namespace

void add_recipe_commands(CLI::App& app, RecipeArguments& a, const std::function<RpcClient()>& connect,
                         const Terminal& terminal, std::function<int()>& chosen) {
  CLI::App* recipe = app.add_subcommand("recipe", "look at recipes, change them, go back to earlier ones");
  recipe->require_subcommand(1);
  const auto command = [recipe, &chosen](const char* name, const char* help, std::function<int()> run) {
    CLI::App* sub = recipe->add_subcommand(name, help);
    sub->callback([&chosen, run = std::move(run)] { chosen = run; });
    return sub;
  };
  const auto add_file = [&a](CLI::App& sub) {
    sub.add_option("file", a.file, "the recipe, a JSON file")->required()->check(CLI::ExistingFile);
  };
  const auto add_id = [&a](CLI::App& sub) { sub.add_option("id", a.id, "recipe id")->required(); };
  const auto add_base = [&a](CLI::App& sub) {
    sub.add_option("--author", a.author, "who changes it; default: the name of the user");
    sub.add_option("--base", a.base_version,
                   "version that the change was made from; as `get` tells; default: 0, the shipped recipe or a new one")
        ->check(CountCheck());
  };
  command("list", "print ids and versions of all recipes", [connect, terminal] { return list(connect(), terminal); });
  add_id(
      *command("get", "print a recipe as it stands", [&a, connect, terminal] { return get(a, connect(), terminal); }));

  CLI::App* sub = command("check", "have the daemon check a recipe; keeps nothing",
                          [&a, connect, terminal] { return check(a, connect(), terminal); });
  add_file(*sub);

  sub = command("save", "keep a recipe as a new version and put it in force",
                [&a, connect, terminal] { return save(a, connect(), terminal); });
  add_file(*sub);
  sub->add_option("--id", a.id, "recipe id; default: the file's name without its suffix");
  sub->add_option("--comment", a.comment, "what was changed");
  add_base(*sub);

  add_id(*command("versions", "print the versions of a recipe, the newest first",
                  [&a, connect, terminal] { return versions(a, connect(), terminal); }));

  sub = command("restore", "save an earlier version of a recipe anew",
                [&a, connect, terminal] { return restore(a, connect(), terminal); });
  add_id(*sub);
  sub->add_option("version", a.version, "which one; 0 = the shipped recipe")->required()->check(CountCheck());
  add_base(*sub);

  add_file(*command("convert", "print a recipe of the old format in the new one, without the daemon",
                    [&a, terminal] { return convert(a, terminal); }));
  add_suggest_filters_options(
      *command("suggest-filters", "suggest filters and evaluation area for texture, without the daemon",
               [&a, terminal] { return run_suggest_filters(a.filters, terminal); }),
      a.filters);
}

}  // namespace fvd::ctl
