# Completion of pscn for fish, made from its tables of options.
function __pscn_is
  set -l word (commandline -opc)[2]
  test "$word" = $argv[1]; or begin; test $argv[1] = render; and string match -qr '[./]' -- $word; end
end
complete -c pscn -f
complete -c pscn -n __fish_use_subcommand -l version -d 'show the version'
complete -c pscn -n __fish_use_subcommand -k -a '(__fish_complete_suffix .pscn)'
{{#commands}}complete -c pscn -n __fish_use_subcommand -a {{command}} -d '{{&fish_summary}}'
{{#argument}}complete -c pscn -n '__pscn_is {{command}}'{{&fish}}
{{/argument}}{{#options}}complete -c pscn -n '__pscn_is {{command}}' -l {{option}}{{#letter}} -s {{letter}}{{/letter}}{{#argument}} -r{{&fish}}{{/argument}} -d '{{&fish_text}}'
{{/options}}{{/commands}}