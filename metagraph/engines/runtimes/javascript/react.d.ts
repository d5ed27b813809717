import type { CSSProperties, ForwardRefExoticComponent, ReactNode, RefAttributes } from "react";
import type { AvatarWorn, MetagraphCharacter, MetagraphCharacterAttributes } from "./element.js";
import type { Happening } from "./index.js";

export interface CharacterProps extends MetagraphCharacterAttributes {
  id?: string;
  className?: string;
  style?: CSSProperties;
  title?: string;
  children?: ReactNode;
  /** Something that is performed or said began, or ended. */
  onBegin?: (happening: Happening) => void;
  onEnd?: (happening: Happening) => void;
  onLoad?: () => void;
  onError?: (error: Error) => void;
  onAvatar?: (worn: AvatarWorn) => void;
}

/** `<metagraph-character>` as a component. Its ref is the element: `ref.current.say("Hello!")`. */
export const Character: ForwardRefExoticComponent<CharacterProps & RefAttributes<MetagraphCharacter>>;
