for output in /dev/full missing/result.toml . ; do
  flightwatt plan "$SOURCE/missions/paper/plan.toml" -o "$output" 2> diagnostics > /dev/null; echo $?; tail -n 1 diagnostics
done
rm diagnostics; ls
