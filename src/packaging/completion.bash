# Completion of pscn for bash, made from its tables of options.
_pscn_words() { # also behind others and a comma
  local before=${word%"${word##*,}"}
  mapfile -t COMPREPLY < <(compgen -P "$before" -W "$1" -- "${word##*,}")
}
_pscn_folders() { compopt -o filenames 2>/dev/null; mapfile -t COMPREPLY < <(compgen -d -- "$word"); }
_pscn_files() {
  local suffix
  compopt -o filenames 2>/dev/null
  if [ $# -eq 0 ]; then mapfile -t COMPREPLY < <(compgen -f -- "$word"); return; fi
  mapfile -t COMPREPLY < <(compgen -d -- "$word"; for suffix; do compgen -f -X "!*.$suffix" -- "$word"; done)
}
_pscn() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} command=${COMP_WORDS[1]}
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    case $word in
      -*) _pscn_words '--help --version' ;;
      */* | *.*) _pscn_files pscn ;;
      *) _pscn_words '{{#commands}}{{^first}} {{/first}}{{command}}{{/commands}}'; [ ${#COMPREPLY[@]} -gt 0 ] || _pscn_files pscn ;;
    esac
    return
  fi
  case $command in *[./]*) command=render ;; esac # `pscn SCENE` renders it
  case $command in
{{#commands}}    {{command}})
      case $before in
{{#options}}{{#argument}}        --{{option}}{{#letter}} | -{{letter}}{{/letter}}) {{&bash}}; return ;;
{{/argument}}{{/options}}      esac
      case $word in
        -*) _pscn_words '{{#options}}{{^first}} {{/first}}--{{option}}{{/options}}' ;;
        *) {{#argument}}{{&bash}}{{/argument}} ;;
      esac ;;
{{/commands}}  esac
}
complete -F _pscn pscn
