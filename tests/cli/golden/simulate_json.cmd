flightwatt simulate "$SOURCE/missions/paper/adaptive.toml" -o soc.csv --json > summary.json || exit
python3 -c 'import json
for key, value in json.load(open("summary.json")).items(): print(key, round(value, 2) if isinstance(value, float) else value)'
wc -l < soc.csv
