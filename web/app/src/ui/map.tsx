// Maps by Leaflet, north at the top, without tiles: nothing is fetched. A scale gives the size.
import { useEffect, useRef } from "preact/hooks";
import L from "leaflet";
import "leaflet/dist/leaflet.css";
import { number, quantity } from "./format";

export type Place = [latitude_deg: number, longitude_deg: number];

export interface Track {
  name: string;
  /// A name of a colour in tokens.css.
  colour: string;
  places: Place[];
  dashed?: boolean;
  closed?: boolean;
  weight?: number;
}

export interface Spot {
  name: string;
  /// Its name is always shown.
  is_named?: boolean;
  colour: string;
  place: Place;
}

export interface Wind {
  m_per_s: number;
  from_deg: number;
}

interface MapProps {
  tracks: Track[];
  spots?: Spot[];
  wind?: Wind | null;
  /// Where the cursor of a plot is.
  cursor?: Place | null;
  height?: number;
  /// Where the map is while nothing is drawn on it.
  view?: Place;
  /// Stays where it is as the drawing changes.
  still?: boolean;
  description: string;
  onClick?: (place: Place) => void;
}

const colour = (name: string) =>
  getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim() || name;

export function TrackMap(props: MapProps) {
  const place = useRef<HTMLDivElement>(null);
  const drawn = useRef<{ map: L.Map; layer: L.LayerGroup; cursor: L.CircleMarker } | null>(null);
  useEffect(() => {
    const element = place.current;
    if (!element) return;
    const map = L.map(element, { attributionControl: false, zoomSnap: 0, scrollWheelZoom: false, maxZoom: 24 });
    L.control.scale({ imperial: false }).addTo(map);
    const cursor = L.circleMarker([0, 0], { radius: 6, color: colour("card"), weight: 2, fillColor: colour("ink"), fillOpacity: 1 });
    drawn.current = { map, layer: L.layerGroup().addTo(map), cursor };
    const resized = new ResizeObserver(() => map.invalidateSize());
    resized.observe(element);
    return () => {
      resized.disconnect();
      map.remove();
      drawn.current = null;
    };
  }, []);
  useEffect(() => {
    if (!drawn.current) return;
    const { map, layer } = drawn.current;
    layer.clearLayers();
    for (const track of props.tracks) {
      const style = { className: `on-${track.colour}`, color: colour(track.colour), weight: track.weight ?? 2.5, dashArray: track.dashed ? "6 5" : undefined };
      (track.closed ? L.polygon(track.places, { ...style, fillOpacity: 0.08 }) : L.polyline(track.places, style))
        .bindTooltip(track.name, { sticky: true })
        .addTo(layer);
    }
    for (const spot of props.spots ?? []) {
      L.circleMarker(spot.place, { radius: 6, color: colour("card"), weight: 2, fillColor: colour(spot.colour), fillOpacity: 1 })
        .bindTooltip(spot.name, { permanent: spot.is_named, direction: "auto", className: spot.is_named ? "map-name" : "" })
        .addTo(layer);
    }
    const all = [...props.tracks.flatMap((track) => track.places), ...(props.spots ?? []).map((spot) => spot.place)];
    const is_set = (map as unknown as { _loaded?: boolean })._loaded;
    if (props.still && is_set) return;
    if (all.length === 0) map.setView(props.view ?? [0, 0], props.view ? 15 : 2);
    else map.fitBounds(L.latLngBounds(all).pad(0.1), { animate: false });
  }, [props.tracks, props.spots, props.view]);
  useEffect(() => {
    if (!drawn.current) return;
    const { map, cursor } = drawn.current;
    if (props.cursor) cursor.setLatLng(props.cursor).addTo(map);
    else cursor.remove();
  }, [props.cursor]);
  useEffect(() => {
    const map = drawn.current?.map;
    const click = (event: L.LeafletMouseEvent) => props.onClick?.([event.latlng.lat, event.latlng.lng]);
    map?.on("click", click);
    return () => {
      map?.off("click", click);
    };
  }, [props.onClick]);
  const map = <div class="map" role="group" aria-label={props.description} style={{ height: `${props.height ?? 320}px` }} ref={place} />;
  if (!props.wind?.m_per_s) return map;
  const { m_per_s, from_deg } = props.wind;
  return (
    <div class="windy-map">
      {map}
      <p class="map-wind">
        <span aria-hidden="true" style={{ transform: `rotate(${from_deg + 180}deg)` }}>↑</span> Wind {quantity(m_per_s, 1, "m/s")} from {number(from_deg, 0)}°
      </p>
    </div>
  );
}
