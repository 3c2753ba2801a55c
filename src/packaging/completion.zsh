#compdef pscn
# Completion of pscn for zsh, made from its tables of options.
local -a subcommands
subcommands=(
{{#commands}}  '{{command}}:{{&zsh_summary}}'
{{/commands}})
if (( CURRENT == 2 )); then
  _describe command subcommands
  _files -g "*.pscn"
else
  shift words
  (( CURRENT-- ))
  [[ $words[1] != *[./]* ]] || words[1]=render # `pscn SCENE` renders it
  case $words[1] in
{{#commands}}    {{command}}) _arguments -S{{#options}} \
      {{#letter}}'(-{{letter}} --{{option}})'{-{{letter}},--{{option}}}{{/letter}}{{^letter}}--{{option}}{{/letter}}'[{{&zsh_text}}]{{#argument}}:{{&zsh_what}}:{{&zsh}}{{/argument}}'{{/options}}{{#argument}} \
      '{{#many}}*{{/many}}{{^many}}1{{/many}}:{{&zsh_what}}:{{&zsh}}'{{/argument}} ;;
{{/commands}}  esac
fi
