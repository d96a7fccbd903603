flightwatt compare "$SOURCE"/missions/paper/[ap]*.toml --json > ranking.json || exit
python3 -c 'import json
for mission in json.load(open("ranking.json")): print(list(mission), mission["mission"], round(mission["final_soc_percent"], 2))'
