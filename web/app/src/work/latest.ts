// Work of which the latest request alone counts, as that of a slider.
import { useEffect, useRef, useState } from "preact/hooks";

/// A slider that has not moved for so long rests.
export const rest_ms = 200;

/// Does the latest of what is asked whenever one of `inputs` changes; while it is under way, what is asked last alone is
/// next. The work returns what it found, or why it found nothing; `refine`, if there is more to find once nothing else
/// is asked, does so. Both are those of the latest inputs, also where these change while the work is under way.
export function useLatest<Asked, Found extends object>(
  asked: Asked | null | undefined,
  work: (asked: Asked) => Promise<Found | string>,
  inputs: unknown[],
  refine?: (asked: Asked, found: Found) => Promise<Found | string> | null,
): { found: Found | null; failed: string; asking: boolean } {
  const [found, setFound] = useState<Found | null>(null);
  const [failed, setFailed] = useState("");
  const [asking, setAsking] = useState(false);
  const wanted = useRef(asked);
  const busy = useRef(false);
  const now = useRef({ work, refine });
  now.current = { work, refine };
  useEffect(() => {
    wanted.current = asked;
    if (asked == null || busy.current) return;
    busy.current = true;
    setAsking(true);
    void (async () => {
      while (wanted.current != null) {
        const latest = wanted.current;
        wanted.current = null;
        const result = await now.current.work(latest).catch((error) => String(error));
        setFailed(typeof result === "string" ? result : "");
        if (typeof result === "string") continue;
        setFound(result);
        if (refine) await new Promise((rested) => setTimeout(rested, rest_ms));
        const finer = wanted.current == null
          ? await now.current.refine?.(latest, result)?.catch((error) => String(error))
          : null;
        if (finer == null || wanted.current != null) continue;
        if (typeof finer === "string") setFailed(finer);
        else setFound(finer);
      }
      busy.current = false;
      setAsking(false);
    })();
  }, inputs);
  return { found, failed, asking };
}
