/** Metagraph in React: the element as a component. Nothing of it runs on a server, where the component is an empty element. */

import { createElement, forwardRef, useEffect, useImperativeHandle, useRef } from "react";

const LISTENERS = { onBegin: "begin", onEnd: "end", onLoad: "load", onError: "error", onAvatar: "avatar" };

export const Character = forwardRef(function Character(props, ref) {
  const element = useRef(null);
  const latest = useRef(props);
  latest.current = props;
  useImperativeHandle(ref, () => element.current, []);
  useEffect(() => {
    const shown = element.current;
    const heard = Object.entries(LISTENERS).map(([name, event]) => [event, (told) => latest.current[name]?.(told.detail)]);
    for (const [event, listener] of heard) shown.addEventListener(event, listener);
    import("./element.js"); // defines the element; whoever asks before that waits for `ready`
    return () => heard.forEach(([event, listener]) => shown.removeEventListener(event, listener));
  }, []);
  const attributes = { ref: element };
  for (const [name, value] of Object.entries(props)) {
    if (name in LISTENERS || value === undefined || value === null || value === false) continue;
    attributes[name === "className" ? "class" : name] = value === true ? "" : value;
  }
  return createElement("metagraph-character", attributes);
});
