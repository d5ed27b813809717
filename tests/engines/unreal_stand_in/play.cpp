// Plays the plugin against the stand-ins: the node shows the vectors' poses, the component a character's.
#include "AnimNode_Metagraph.cpp"
#include "MetagraphAsset.cpp"
#include "MetagraphAnimInstance.cpp"
#include "MetagraphComponent.cpp"
#include "MetagraphModule.cpp"
#include "MetagraphShown.cpp"

#include "AnimGraphNode_Metagraph.cpp"
#include "MetagraphEditorModule.cpp"
#include "MetagraphFactory.cpp"

#undef PI
#undef check
#undef verify
#include <iostream>

#include "Core/conformance.hpp"

static FString Wide(const std::string& text) { return MetagraphText::Unreal(text); }

/// A mesh with a graph's joints, in another order, one left out by its level of detail, and a bone that is not the export's.
static FPoseContext Mesh(const metagraph::Graph& graph, std::size_t left_out) {
    FPoseContext out;
    FBoneContainer& bones = out.Pose.Container;
    bones.Bones.push_back(FName(u"attachment"));
    bones.Compact.push_back(0);
    for (std::size_t n = graph.joints.size(); n-- > 0;) {
        bones.Bones.push_back(FName(*Wide(graph.joints[n])));
        bones.Compact.push_back(n == left_out ? INDEX_NONE : static_cast<int32>(out.Pose.Transforms.size() + 1));
        if (n != left_out) out.Pose.Transforms.emplace_back();
    }
    out.Pose.Transforms.emplace_back();
    return out;
}

/// What a mesh shows, in the export's space again.
static metagraph::List<metagraph::Joined> Shown(const metagraph::Graph& graph, FPoseContext& output) {
    metagraph::List<metagraph::Joined> out;
    const FBoneContainer& bones = output.Pose.Container;
    for (const std::string& joint : graph.joints) {
        const FMeshPoseBoneIndex place(bones.GetPoseBoneIndexForBoneName(FName(*Wide(joint))));
        const FTransform& bone = output.Pose[bones.MakeCompactPoseIndex(place)];
        const FQuat turn = MetagraphSpace::FromUnreal(bone.GetRotation());
        const FVector at = MetagraphSpace::FromUnreal(bone.GetLocation());
        out.push_back({{turn.X, turn.Y, turn.Z, turn.W}, {at.X, at.Y, at.Z}});
    }
    return out;
}

static int Vectors(const std::string& folder, UMetagraphAsset& asset) {
    const std::string text = *metagraph::conformance::file(folder + "/vectors.json");
    metagraph::json::Parser parser(text);
    const metagraph::Json vectors = parser.parse();
    const metagraph::Ref<const metagraph::Graph> graph = asset.Graph()->Graph;
    int poses = 0, failures = 0;
    for (const metagraph::Json& one : vectors.find("cases")->items) {
        metagraph::Player player(graph, metagraph::conformance::planned(*graph, one));
        for (const metagraph::Json& pose : one.find("poses")->items) {
            const double time = pose.find("time")->number;
            const bool alive = pose.find("alive")->flag;
            metagraph::List<double> morphs;
            player.morphs(time, morphs, alive);
            FAnimNode_Metagraph node;
            node.Take(MetagraphPoses::Made(MetagraphPoses::Bones(*graph), player.pose(time, alive)));
            FPoseContext output = Mesh(*graph, graph->joints.size());
            node.Evaluate_AnyThread(output);
            metagraph::conformance::compare_pose(
                *graph, Shown(*graph, output), morphs, pose, *vectors.find("tolerance"),
                [&](const std::string& what) { failures += (std::cout << one.find("name")->text << ": " << what << "\n", 1); }
            );
            poses++;
        }
    }
    std::cout << poses << " poses\n";
    return failures;
}

/// Round trips, and that turning and then changing space is changing space and then turning.
static int Space() {
    std::uint32_t seed = 7;
    auto draw = [&seed]() { return (seed = metagraph::hashing::mix(seed + 1)) / 4294967296.0 * 2 - 1; };
    double off = 0;
    for (int n = 0; n < 1000; n++) {
        const metagraph::Quat q = metagraph::rotation::normalized({draw(), draw(), draw(), draw()});
        const metagraph::Vec v{draw(), draw(), draw()};
        const FQuat turn = MetagraphSpace::ToUnreal(q.x, q.y, q.z, q.w);
        const FVector place = MetagraphSpace::ToUnreal(v.x, v.y, v.z);
        const FQuat back = MetagraphSpace::FromUnreal(turn);
        const FVector there = MetagraphSpace::FromUnreal(place);
        const metagraph::Vec turned = metagraph::rotation::rotate(q, v);
        const FVector same = MetagraphSpace::ToUnreal(turned.x, turned.y, turned.z) - turn.RotateVector(place);
        for (const double x : {back.X - q.x, back.Y - q.y, back.Z - q.z, back.W - q.w, there.X - v.x, there.Y - v.y, there.Z - v.z,
                               same.X, same.Y, same.Z}) {
            off = std::max(off, std::abs(x));
        }
    }
    const FVector up = MetagraphSpace::ToUnreal(0, 1, 0), ahead = MetagraphSpace::ToUnreal(0, 0, 1);
    std::cout << (off < 1e-9 ? "fits" : "is off") << " up " << up.Z << " ahead " << ahead.Y << "\n";
    return off < 1e-9 ? 0 : 1;
}

static int Play(UMetagraphAsset& asset) {
    AActor actor;
    UAnimInstance instance;
    USkeletalMeshComponent mesh;
    struct Component : UMetagraphComponent {
        UClass* GetClass() const override { return UMetagraphComponent::StaticClass(); }
    } component;
    actor.Components = {&mesh, &component};
    component.Owner = mesh.Owner = &actor;
    mesh.Transform.Place = FVector(1000, 0, 0);
    instance.Actor = &actor;
    int begun = 0, ended = 0;
    component.OnBegin.Listeners.push_back([&](FString, FString, FString) { begun++; });
    component.OnEnd.Listeners.push_back([&](FString, FString, FString) { ended++; });
    std::cout << "before " << FTCHARToUTF8(*component.Answer(FString(u"x")).State).Get() << "\n";
    component.Asset = &asset;
    component.Seed = 3;
    component.BeginPlay();
    const TArray<FString> ids = component.Hear(TArray<FString>({FString(u"{\"do\": \"gesture\"}"), FString(u"nonsense"), FString(u"{\"do\": \"gesture\", \"tags\": [\"no such tag\"]}")}));
    const FString said = component.Say(FString(u"Grüße!")), look = component.LookAt(FVector(1100, 200, 150));
    FAnimNode_Metagraph node;
    FAnimInstanceProxy proxy;
    FPoseContext output = Mesh(*asset.Graph()->Graph, 2);
    proxy.Required = output.Pose.Container;
    FAnimationCacheBonesContext cached;
    cached.AnimInstanceProxy = &proxy;
    for (int frame = 0; frame < 300; frame++) {
        component.TickComponent(0.02f, LEVELTICK_All, nullptr);
        node.PreUpdate(&instance);
        if (frame % 100 == 0) node.CacheBones_AnyThread(cached);
        node.Update_AnyThread({});
        node.Evaluate_AnyThread(output);
    }
    for (const FString& id : ids) std::cout << FTCHARToUTF8(*component.Answer(id).State).Get() << " ";
    std::cout << FTCHARToUTF8(*component.Answer(said).State).Get() << " " << FTCHARToUTF8(*component.Answer(look).State).Get() << "\n";
    std::cout << (begun > 0 && ended > 0 ? "told" : "not told") << " " << (mesh.Before == &component) << " "
              << (component.Pose()->Transforms.Num() == static_cast<int32>(asset.Graph()->Graph->joints.size())) << " "
              << (component.Describe().Contains(u"\"layers\"") ? 1 : 0) << "\n";
    const int32 early = component.SayPiece(FString(u"Hello"), false).Num();
    std::cout << FTCHARToUTF8(*said).Get() << " " << early;
    for (const FString& id : component.SayPiece(FString(u" there! No"), true)) std::cout << " " << FTCHARToUTF8(*id).Get();
    component.bGestures = false;
    std::cout << " " << FTCHARToUTF8(*component.Say(FString(u"Hello there!"))).Get() << "\n";
    const FString asked[] = {
        component.Gesture(TArray<FString>()), component.Gesture(TArray<FString>({FString(u"no such tag")})), component.Stance(FString(u"nowhere"), true), component.PlacePoint(FString(u"door"), FVector(1100, 200, 150)),
        component.Mood(FString(u"happy"), 0.5f), component.Mode(FString(u"listening")), component.Mode(FString(u"")), component.Interrupt(),
    };
    for (int frame = 0; frame < 10; frame++) component.TickComponent(0.02f, LEVELTICK_All, nullptr);
    std::cout << "asked";
    for (const FString& id : asked) std::cout << " " << FTCHARToUTF8(*component.Answer(id).State).Get();
    std::cout << "\n";
    return 0;
}

/// Makes what evaluates it, as Unreal does.
struct Instance : UMetagraphAnimInstance {
    std::unique_ptr<FAnimInstanceProxy> Made() { return std::unique_ptr<FAnimInstanceProxy>(CreateAnimInstanceProxy()); }
};

/// Without an animation blueprint: what the mesh shows is the component's pose, and morph targets are curves.
static int Drive(UMetagraphAsset& asset) {
    AActor actor;
    USkeletalMeshComponent mesh, other;
    struct Component : UMetagraphComponent {
        UClass* GetClass() const override { return UMetagraphComponent::StaticClass(); }
    } component;
    actor.Components = {&mesh, &component};
    component.Owner = mesh.Owner = &actor;
    component.Asset = &asset;
    component.BeginPlay();
    std::cout << "class " << (mesh.Class == UMetagraphAnimInstance::StaticClass());
    component.bDriveMesh = false;
    mesh.Class = nullptr;
    component.BeginPlay();
    std::cout << " " << (mesh.Class == nullptr) << "\n";
    component.Say(FString(u"Hello! How are you?"));
    Instance instance;
    instance.Actor = &actor;
    const std::unique_ptr<FAnimInstanceProxy> proxy = instance.Made();
    const metagraph::Graph& graph = *asset.Graph()->Graph;
    FPoseContext output = Mesh(graph, graph.joints.size());
    proxy->Required = output.Pose.Container;
    float most = 0;
    double apart = 0;
    int shown = 0;
    for (int frame = 0; frame < 100; frame++) {
        component.TickComponent(0.02f, LEVELTICK_All, nullptr);
        proxy->PreUpdate(&instance, 0.02f);
        if (frame == 0) proxy->CacheBones();
        shown += proxy->Evaluate(output);
        const FMetagraphPose& pose = *component.Pose();
        for (int32 n = 0; n < pose.Curves.Num(); n++) {
            most = std::max(most, output.Curve.Get(pose.Curves[n]));
            apart = std::max(apart, static_cast<double>(std::abs(output.Curve.Get(pose.Curves[n]) - mesh.Morphs[pose.Curves[n]])));
        }
        for (int32 n = 0; n < pose.Bones.Num(); n++) {
            const FMeshPoseBoneIndex place(output.Pose.Container.GetPoseBoneIndexForBoneName(pose.Bones[n]));
            const FVector off = output.Pose[output.Pose.Container.MakeCompactPoseIndex(place)].GetLocation() - pose.Transforms[n].GetLocation();
            apart = std::max({apart, std::abs(off.X), std::abs(off.Y), std::abs(off.Z)});
        }
    }
    std::cout << "shown " << shown << " " << (apart < 1e-6 ? "same" : "apart") << " " << (most > 0.05f ? "curves" : "still") << "\n";
    FAnimNode_Metagraph face;
    face.Take(component.Pose());
    face.bBones = false;
    face.Alpha = 0.5f;
    FPoseContext half = Mesh(graph, graph.joints.size());
    face.Evaluate_AnyThread(half);
    double moved = 0, wrong = 0;
    for (const FTransform& one : half.Pose.Transforms) moved += std::abs(one.GetLocation().Z);
    for (int32 n = 0; n < component.Pose()->Curves.Num(); n++) {
        wrong += std::abs(half.Curve.Get(component.Pose()->Curves[n]) - component.Pose()->Weights[n] / 2);
    }
    for (const auto& one : half.Curve.Flags) wrong += one.second != UE::Anim::ECurveElementFlags::MorphTarget;
    wrong += half.Curve.Flags.size() != half.Curve.Values.size();
    std::cout << "face " << (moved == 0 && wrong < 1e-6 ? "alone" : "wrong") << " " << component.Pose()->Curves.Num() << "\n";
    return 0;
}

/// Parameters of the project as a game sets them.
static int Parameters(UMetagraphAsset& asset) {
    AActor actor;
    UMetagraphComponent component;
    component.Owner = &actor;
    const auto word = [](const FString& text) { return std::string(FTCHARToUTF8(*text).Get()); };
    std::cout << "before " << word(component.SetParameterSwitch(FString(u"x"), true)).empty() << word(component.Parameter(FString(u"energy"))).empty() << "\n";
    component.Asset = &asset;
    component.BeginPlay();
    const FString asked[] = {
        component.SetParameterChoice(FString(u"mood"), FString(u"happy")), component.SetParameterNumber(FString(u"energy"), 0.5f),
        component.PlayParameter(FString(u"nod")), component.SetParameterPoint(FString(u"partner"), FVector(100, 200, 150)), component.SetParameterSwitch(FString(u"listening"), true),
        component.SetParameterChoices(FString(u"gesture_with"), TArray<FString>({FString(u"greeting")})),
        component.SetParameterChoices(FString(u"mood"), TArray<FString>({FString(u"happy")})), component.SetParameterSwitch(FString(u"mood"), true),
        component.SetParameterChoice(FString(u"nobody"), FString(u"x")),
    };
    component.TickComponent(0.02f, LEVELTICK_All, nullptr);
    std::cout << "set";
    for (const FString& id : asked) std::cout << " " << word(component.Answer(id).State);
    std::cout << "\nvalues " << word(component.Parameter(FString(u"mood"))) << " " << word(component.Parameter(FString(u"energy"))) << "\n";
    return 0;
}

int main(int, char** words) {
    const std::string what = words[1];
    if (what == "space") return Space();
    UMetagraphFactory factory;
    FFeedbackContext feedback;
    bool cancelled = true;
    const FString file = Wide(words[2]);
    const bool can = factory.FactoryCanImport(file);
    UObject* made = factory.FactoryCreateFile(UMetagraphAsset::StaticClass(), nullptr, FName(u"x"), RF_NoFlags, file, nullptr, &feedback, cancelled);
    if (made == nullptr || !can || cancelled) {
        std::cout << (can ? "can " : "cannot ") << feedback.Said;
        return 3;
    }
    UMetagraphAsset& asset = static_cast<UMetagraphAsset&>(*made);
    const int out = what == "vectors" ? Vectors(words[3], asset) : what == "play" ? Play(asset) : what == "drive" ? Drive(asset) : what == "parameters" ? Parameters(asset) : 0;
    delete made;
    return out;
}
