/** Metagraph in React Three Fiber: a scene that useGLTF or useLoader has read is moved in each frame. */

import { useFrame } from "@react-three/fiber";
import { useMemo } from "react";
import { MetagraphObject } from "./three.js";

export function useCharacter(graph, scene, options) {
  const object = useMemo(() => new MetagraphObject(graph, scene, options), [graph, scene]);
  useFrame((state, delta) => object.update(delta));
  return object;
}
