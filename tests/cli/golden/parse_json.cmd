flightwatt parse "$SOURCE/logs/opterra_synthetic_01.data" --json > summary.json || exit
python3 -c 'import json; s = json.load(open("summary.json")); s["usual_interval_s"] = round(s["usual_interval_s"], 6); print(json.dumps(s, indent=1))'
