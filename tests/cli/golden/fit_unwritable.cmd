for output in /dev/full missing/result.csv /proc/result.csv . ; do
  flightwatt fit "$SOURCE/logs/opterra_synthetic_02.data" -o "$output" 2> diagnostics > /dev/null; echo $?; tail -n 1 diagnostics | sed "s,\(/proc/[a-z.]*\): .*,\1: CAUSE,"
done
rm diagnostics; ls
