flightwatt battery "$SOURCE"/logs/opterra_synthetic_0[12].data --json > battery.json || exit
python3 -c 'import json
battery = json.load(open("battery.json"))
print(list(battery), list(battery["resistance_ohm"]), list(battery["left_out"][0]))
print(round(battery["resistance_ohm"]["value"], 3), round(battery["voltage_rms_mv"], 1), battery["capacity_from"])'
