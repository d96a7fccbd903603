for output in /dev/full missing/result.csv /proc/result.csv . ; do
  flightwatt compare "$SOURCE/missions/paper/phased.toml" -o "$output" 2> diagnostics > /dev/null; echo $?; tail -n 1 diagnostics | sed "s,\(/proc/[a-z.]*\): .*,\1: CAUSE,"
done
rm diagnostics; ls
