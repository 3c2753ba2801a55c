# Help and version go to stdout; without a command help goes to stderr.
try pscn --version
try pscn help
try pscn --help >/dev/null
cmp <(try pscn 2>&1 >/dev/null | cat) <(pscn help) && try pscn 2>/dev/null
for command in dump help; do try pscn help $command; done
for command in render trace dump compare help; do
  pscn $command --help | cmp - <(pscn help $command) && echo "--help is the same"
done
pscn help -h | cmp - <(pscn help help) && echo "-h is the same"
try pscn help nothing
try pscn help render trace
try pscn nothing
try pscn --nothing
try pscn --version now
PSCN_KERNEL=none try pscn dump scene
# What is not a command.
for topic in solver channels; do try pscn help $topic; done
