flightwatt batch "$SOURCE"/logs/opterra_synthetic_0[1-3].data -o out >/dev/null 2>&1
flightwatt report out "$SOURCE/missions/paper/phased.toml" --json
echo "other options than the batch's:"
flightwatt report out --order 2 --json | grep -c '"id"'
flightwatt report out out --json; echo "exit $?"
flightwatt report --json; echo "exit $?"
