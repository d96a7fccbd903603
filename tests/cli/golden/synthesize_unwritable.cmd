touch file
for output in file /proc/x; do
  flightwatt synthesize "$SOURCE/fits/mechanical/opterra-table1.toml" -o $output 2> diagnostics; echo $?
  sed 's,\(/proc/x\): .*,\1: CAUSE,' diagnostics
done
