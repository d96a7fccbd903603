mkdir in; cp "$SOURCE"/logs/opterra_synthetic_0[1-2].* in; : > in/bad.data
flightwatt batch in --jobs 1 -o out --json > summary.json 2> /dev/null; code=$?
python3 -c 'import json; s = json.load(open("summary.json")); print(list(s)); print(*s["logs"], sep="\n")'
exit $code
