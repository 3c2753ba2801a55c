#!/bin/bash
# pages.sh BUILD: what is installed for man, shells and editors has every command, option and word that the program has,
# and is well-formed for its readers, as far as these are installed.
set -uo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
installed=$(cmake --install "$1" --prefix "$folder") || exit 1
share=$folder/share
failed=0
say() { echo "$*"; failed=1; }
grep -qF "export PATH=$folder/bin:\$PATH LD_LIBRARY_PATH=$folder/lib" <<<"$installed" || say "the installation does not say what to export"
have() { command -v "$1" >/dev/null || { echo "$1 is not installed: what it reads is not looked at" >&2; false; }; }

# The words of `pscn help` before lists of commands, and of a command's options.
commands=$("$PSCN" help | sed -n 's/^  \([a-z]\{1,\}\) .*/\1/p')
options_of() { "$PSCN" help "$1" | sed -n 's/^  \(-., \|    \)\(--[a-z-]*\).*/\2/p' | sort; }
[ "$(wc -w <<<"$commands")" -ge 8 ] || say "pscn help lists only: $commands"

# Manual pages, with every option.
for command in $commands; do
  page=$share/man/man1/pscn-$command.1
  [ -s "$page" ] || { say "there is no page of $command"; continue; }
  for option in $(options_of "$command"); do
    grep -qF -e "${option//-/\\-}" "$page" || say "pscn-$command.1 does not tell of $option"
  done
  grep -qF "pscn\\-$command" "$share/man/man1/pscn.1" || say "pscn.1 does not name pscn-$command"
done
if have groff; then
  for page in "$share"/man/man?/*.?; do
    warnings=$(groff -man -ww -z -Kutf8 "$page" 2>&1)
    [ -z "$warnings" ] || say "$warnings"
  done
  text=$(groff -man -Tascii -P-c "$share/man/man5/pscn.5" | sed 's/.\x08//g')
  grep -q '^ *camera { }$' <<<"$text" && ! grep -q '[`]\|\*\*\|](' <<<"$text" || say "pscn(5) shows Markdown"
  diff <(groff -man -Tutf8 -Kutf8 -P-c "$share/man/man3/pscn.3" | sed -n '/pscn: exact/,$ s/^       //p' | grep -v '^$') \
    <(grep -v '^$' "$folder/include/pscn.h") >/dev/null || say "pscn(3) is not the header"
fi

# Scenes and examples, which run where they are.
(cd "$folder" && "$PSCN" render "$share/pscn/scenes/dome.pscn" --size 4x3 -q -o dome.png && [ -x "$share/doc/pscn/examples/library/depth_map.py" ] &&
  [ "$("$share/doc/pscn/examples/generate.sh" hair 10 | grep -c bicubic_patch)" = 10 ] && [ -s "$share/doc/pscn/docs/language.md" ] && rm dome.png) ||
  say "scenes, examples or documents are not installed"

# bash: the program takes what is offered after a line.
. "$share/bash-completion/completions/pscn"
offer() { COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)); _pscn; printf '%s\n' "${COMPREPLY[@]}" | sort; }
[ "$(offer pscn '' | grep -c .)" -ge "$(wc -w <<<"$commands")" ] || say "bash is not offered all commands"
for command in $commands; do
  diff <(offer pscn "$command" --) <(options_of "$command") || say "bash is offered other options of $command"
done
[ "$(offer pscn render --solver ab)" = aberth ] || say "bash is offered no solver"
[ "$(offer pscn help ren)" = render ] || say "bash is offered no command behind help"
[ "$(offer pscn help sol)" = solver ] || say "bash is offered no topic behind help"
[ "$(offer pscn render --channels rgb,dep)" = rgb,depth ] || say "bash is offered no channel behind a comma"
diff <(offer pscn bowl.pscn --) <(options_of render) || say "bash is offered no options behind a scene"
(cd "$folder" && touch one.pscn two.png three.txt && mkdir four &&
  diff <(offer pscn trace '' | tr '\n' ' ') <(echo -n "bin four include lib one.pscn share " | tr '\n' ' ') &&
  diff <(offer pscn compare t) <(echo two.png) && diff <(offer pscn render -o t) <(printf 'three.txt\ntwo.png\n') &&
  diff <(offer pscn on) <(echo one.pscn)) || say "bash is offered other files"

if have fish; then
  offer() { fish --no-config -c "source $share/fish/vendor_completions.d/pscn.fish; complete -C '$*'" | cut -f1 | sort; }
  for command in $commands; do
    diff <(offer "pscn $command --" | grep -o -e '^--[a-z-]*') <(options_of "$command") || say "fish is offered other options of $command"
  done
  [ "$(offer 'pscn render --solver ab')" = aberth ] || say "fish is offered no solver"
  diff <(offer 'pscn bowl.pscn --' | grep -o -e '^--[a-z-]*') <(options_of render) || say "fish is offered no options behind a scene"
  [ "$(offer 'pscn render --channels rgb,dep')" = rgb,depth ] || say "fish is offered no channel behind a comma"
  [ "$(offer 'pscn tra')" = trace ] || say "fish is offered no command"
fi
if have zsh; then
  zsh -n "$share/zsh/vendor-completions/_pscn" || say "zsh does not read its completions"
  for command in $commands bowl.pscn; do
    # Its arguments for _arguments, as words.
    told=$(zsh -fc "_arguments() { print -rl -- \"\$@\"; }; words=(pscn $command '') CURRENT=3
      _describe() { :; }; . $share/zsh/vendor-completions/_pscn" | grep -o -e '^\(([^)]*)\)\?--[a-z-]*' | sed 's/.*)//' | sort)
    diff <(echo "$told") <(options_of "${command/bowl.pscn/render}") || say "zsh is offered other options of $command"
  done
fi

# Editors: words of each kind at their places in a scene.
cat >"$folder/words.pscn" <<'END'
camera { location 1.5 } // a
sphere { x }
solver aberth { polish on }
#declare A = "b";
END
if have vim; then
  vim -es -u NONE -i NONE --cmd "set rtp^=$share/vim/vimfiles" --cmd 'filetype on' -c 'syntax on' -c "edit $folder/words.pscn" \
    -c "call writefile(map([[1,1],[1,10],[1,19],[1,25],[2,1],[2,10],[3,1],[3,9],[3,17],[4,1],[4,15]], 'synIDattr(synID(v:val[0], v:val[1], 1), \"name\")'), '$folder/names')" \
    -c 'quit!' >/dev/null 2>&1
  diff <(tr '\n' ' ' <"$folder/names") <(echo -n "pscnStatement pscnItem pscnNumber pscnComment pscnForeign pscnValue \
pscnSolverName pscnSolver pscnSolverWord pscnDirective pscnString ") || say "Vim takes words for other than they are"
fi
if have python3; then
  python3 - "$share/pscn/vscode" "$folder/words.pscn" <<'END' || say "VS Code takes words for other than they are"
import json, os, re, sys
folder, scene = sys.argv[1:]
package = json.load(open(folder + "/package.json"))
language = package["contributes"]["languages"][0]
json.load(open(os.path.join(folder, language["configuration"])))
grammar = json.load(open(os.path.join(folder, package["contributes"]["grammars"][0]["path"])))
assert grammar["scopeName"] == package["contributes"]["grammars"][0]["scopeName"]
rules = {rule["name"]: re.compile(rule["match"]) for rule in grammar["patterns"] if "match" in rule and "name" in rule}
for name, word in (("keyword.control.pscn", "camera"), ("support.type.pscn", "location"), ("invalid.illegal.pscn", "sphere"),
                   ("constant.language.pscn", "x"), ("keyword.control.directive.pscn", "#declare")):
    found = rules[name].search(open(scene).read())
    assert found and found.group(0) == word, (name, found)
END
fi
exit "$failed"
